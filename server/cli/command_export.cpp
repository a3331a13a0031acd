// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options/value_semantic.hpp>
#include <filesystem>
#include <sstream>
#include <vector>

#include "cli/arguments.h"
#include "cli/atomic_file.h"
#include "cli/commands.h"
#include "cli/html_export.h"
#include "network/glob.h"
#include "outputs/output_name.h"
#include "recording/replay/export.h"
#include "reports/console.h"
#include "run/files.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

struct Order {
  const replay::RecordingFile& file;
  std::vector<std::string> topics;  ///< globs; empty: all
  std::string out;
};

bool is_wanted(const Order& order, const std::string& topic) {
  return order.topics.empty() || std::ranges::any_of(order.topics, [&](const auto& glob) {
           return network::matches(glob, topic);
         });
}

std::string to_csv(const Order& order) {
  AtomicFile out(order.out);
  const auto states = replay::export_csv(order.file, out.path());
  out.commit();
  return fmt::format("{} states", states);
}
std::string to_jsonl(const Order& order) {
  const auto wanted = [&](const std::string& topic) { return is_wanted(order, topic); };
  AtomicFile out(order.out);
  const auto messages = replay::export_jsonl(order.file, wanted, out.path());
  out.commit();
  return fmt::format("{} messages", messages);
}
std::string to_html(const Order& order) {
  const auto size = export_html(run::shared_folder("web") + "/player.html",
                                std::filesystem::path(order.file.path()).filename().string(),
                                order.file.reader(), order.out);
  return fmt::format("{} kB, opens in any browser", (size + 999) / 1000);
}

/// A format of files. What it writes is told in words.
struct Format {
  const char* option;
  const char* value;
  const char* ending;
  const char* help;
  std::string (*write)(const Order&);
};
constexpr Format formats[] = {
    {"csv", "FILE.csv", ".csv", "poses of all entities at every tick, with the columns of --trace",
     to_csv},
    {"jsonl", "FILE.jsonl", ".jsonl", "each message as a line of JSON: topic, time_s, message",
     to_jsonl},
    {"html", "FILE.html", ".html",
     "one page that plays the recording in a browser, without a server or a network", to_html},
};

po::options_description export_options() {
  po::options_description options("Options", 96);
  for (const Format& format : formats) {
    options.add_options()(format.option, po::value<std::string>()->value_name(format.value),
                          format.help);
  }
  options.add_options()  //
      ("topics", po::value<std::vector<std::string>>()->composing()->value_name("GLOB"),
       "jsonl: only topics that match, as '/robots/*/command'; may be repeated")(
          "quiet", "no message on what was written");
  return options;
}

bool has_format(const po::variables_map& values) {
  return std::ranges::any_of(formats,
                             [&](const Format& format) { return values.count(format.option) > 0; });
}

/// Checks the outputs of all formats, before the first one is written.
void check_outputs(const po::variables_map& values, const std::string& recording) {
  std::vector<outputs::TakenFile> taken{{recording, "the recording itself"}};
  for (const Format& format : formats) {
    if (!values.count(format.option)) continue;
    const auto path = values[format.option].as<std::string>();
    outputs::check_output({fmt::format("--{}", format.option), path, {format.ending}}, taken);
    taken.push_back({path, "the file of another format too"});
  }
}

}  // namespace

std::string help_export() {
  std::ostringstream text;
  text
      << R"(usage: ziggurat export RECORDING --csv FILE.csv | --jsonl FILE.jsonl | --html FILE.html [OPTION]...

Writes what a recording has as a file for other programs, or as a page for people. Nothing is simulated.

  ziggurat export run.mcap --html run.html
  ziggurat export run.mcap --csv poses.csv
  ziggurat export run.mcap --jsonl commands.jsonl --topics '/robots/*/command'
  ziggurat export run.mcap --csv - | head

Poses of links are exact in a table. Those of origins are computed from them, and can differ from a
trace of the run in the last digit.

Exit codes: 0 done; 1 fault of arguments or recording.

)" << export_options();
  return text.str();
}

int execute_export(const Arguments& arguments) {
  const Parsed parsed = parse(arguments, export_options());
  const replay::RecordingFile file(only_recording("export", parsed.positional));
  reports::Console console({parsed.values.count("quiet") > 0, false});
  if (const auto missing = file.shortcoming(); !missing.empty()) console.warning(missing);
  check_needs(Values(parsed.values), {"topics"}, "jsonl");
  Order order{file, {}, {}};
  if (parsed.values.count("topics")) {
    order.topics = parsed.values["topics"].as<std::vector<std::string>>();
  }
  if (!has_format(parsed.values)) {
    throw text::UsageError(
        "no format is given; write --csv FILE.csv, --jsonl FILE.jsonl or --html FILE.html");
  }
  check_outputs(parsed.values, file.path());
  for (const Format& format : formats) {
    if (!parsed.values.count(format.option)) continue;
    order.out = parsed.values[format.option].as<std::string>();
    console.report(fmt::format("{}: {}", order.out, format.write(order)));
  }
  console.flush();
  return exit_code::finished;
}

}  // namespace ziggurat::cli
