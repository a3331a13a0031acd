// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <boost/program_options/value_semantic.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "outputs/output_file.h"
#include "outputs/output_name.h"
#include "reports/console.h"
#include "rerun/divergence.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

po::options_description diff_options() {
  po::options_description options("Options", 96);
  options.add_options()  //
      ("plot", po::value<std::string>()->value_name("FILE.svg"),
       "distances over time as a picture")("json", "the result as a JSON object");
  return options;
}

void check_plot(const std::string& out, const std::vector<std::string>& recordings, bool as_json) {
  std::vector<outputs::TakenFile> taken;
  for (const std::string& path : recordings)
    taken.push_back({path, "a recording that is compared"});
  outputs::check_output({"--plot", out, {".svg"}}, taken);
  if (out == "-" && as_json) {
    throw text::UsageError("--plot is '-', and stdout is for the object of --json; name a file");
  }
}

}  // namespace

std::string help_diff() {
  std::ostringstream text;
  text << R"(usage: ziggurat diff A B [OPTION]...

Compares two recordings state by state: the first tick, entity and field that differ, the first inputs
that differ (commands, acts of supervisors), then how far poses are apart over time, and of which link
most.

  ziggurat diff before.mcap after.mcap --plot apart.svg
      with - instead of a file the picture goes to stdout, and the table to stderr

Exit codes: 0 all states are the same; 5 they differ; 1 fault of arguments or recordings, or no states
to compare.

)" << diff_options();
  return text.str();
}

int execute_diff(const Arguments& arguments) {
  const Parsed parsed = parse(arguments, diff_options());
  if (parsed.positional.size() != 2) {
    throw text::UsageError("two recordings must be given, as in: ziggurat diff a.mcap b.mcap");
  }
  const std::string out = Values(parsed.values).text("plot");
  const bool as_json = parsed.values.count("json") > 0;
  if (!out.empty()) check_plot(out, parsed.positional, as_json);
  const replay::RecordingFile a(parsed.positional[0]), b(parsed.positional[1]);
  const rerun::Divergence divergence = rerun::compare(a, b);
  if (divergence.compared == 0) {
    throw text::UsageError(fmt::format(
        "there are no states to compare: {} has {}, {} has {}, and none of them has the "
        "same tick; 'ziggurat info FILE' tells what each has",
        a.path(), divergence.only_a, b.path(), divergence.only_b));
  }
  reports::Console console;
  for (const auto* file : {&a, &b}) {
    if (const auto missing = file->shortcoming(); !missing.empty()) {
      console.warning(file->path() + ": " + missing);
    }
  }
  if (!out.empty()) {
    outputs::OutputFile plot(out);
    plot.buffer().append(to_svg(divergence));
    plot.close();
  }
  std::string text = as_json ? to_json(divergence) : to_text(divergence);
  if (text.ends_with('\n')) text.pop_back();
  out == "-" ? console.report(text) : console.result(text);
  console.flush();
  return divergence.is_same() ? exit_code::finished : exit_code::differs;
}

}  // namespace ziggurat::cli
