// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <boost/program_options/options_description.hpp>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <numeric>

#include "cli/arguments.h"
#include "cli/sweep_options.h"
#include "outputs/output_file.h"
#include "outputs/output_name.h"
#include "reports/console.h"
#include "scene/values.h"
#include "sweep/columns.h"
#include "sweep/folder.h"
#include "sweep/ledger.h"
#include "sweep/means.h"
#include "sweep/plot.h"
#include "sweep/slurm.h"
#include "text/names.h"
#include "text/numbers.h"
#include "text/quoting.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

/// A folder's sweep, as far as it got.
struct SweepState {
  sweep::Folder folder;
  sweep::Experiment experiment;
  std::vector<sweep::Result> results;
  std::map<std::string, std::string> scene_files;  ///< hashes by path
};

SweepState look(const char* verb, const Parsed& parsed) {
  if (parsed.positional.size() != 1) {
    throw text::UsageError(
        fmt::format("one folder of a sweep is expected; write: ziggurat sweep {} DIR", verb));
  }
  sweep::Folder folder(parsed.positional.front());
  sweep::Definition definition = folder.definition();
  auto results = folder.results();
  return {std::move(folder), std::move(definition.experiment), std::move(results),
          std::move(definition.files)};
}

double confidence_of(const Values& values) {
  if (!values.has("confidence")) return 0.95;
  const double value = text::to_number("--confidence", values.text("confidence"));
  if (value > 0 && value < 1) return value;
  throw text::UsageError(fmt::format("--confidence is {}; it must be between 0 and 1: 0.95",
                                     values.text("confidence")));
}

/// @throws text::UsageError if no run has it
std::string check_measure(const std::string& name, const std::vector<std::string>& known) {
  if (std::ranges::find(known, name) != known.end()) return name;
  throw text::UsageError(fmt::format(
      "no run has a metric {}; {}", scene::in_quotes(name),
      text::advice(name, known, fmt::format("known here: {}", fmt::join(known, ", ")))));
}

/// Metrics, and without any of those what every run has.
std::vector<std::string> usual_measures(const std::vector<sweep::Result>& results) {
  const auto metrics = sweep::metric_names(results);
  std::vector<std::string> names(metrics.begin(), metrics.end());
  if (names.empty()) names = {"ticks", "simulated_s"};
  return names;
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "-";
}

using Rows = std::vector<std::vector<std::string>>;

/// In columns of equal width.
std::string aligned(const Rows& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  text.pop_back();
  return text;
}

std::string as_csv(const Rows& rows) {
  std::string text;
  for (const auto& row : rows) {
    std::vector<std::string> fields;
    std::ranges::transform(row, std::back_inserter(fields), text::csv_field);
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  text.pop_back();
  return text;
}

/// A row for each combination of the axes, with means and halves of their intervals.
Rows table_of_means(const SweepState& sofar, const std::vector<std::size_t>& axes,
                    const std::vector<std::string>& measures, double confidence) {
  Rows rows(1);
  for (const std::size_t axis : axes) rows[0].push_back(sofar.experiment.axes[axis].name);
  rows[0].insert(rows[0].end(), {"runs", "failed"});
  for (const std::string& measure : measures) {
    rows[0].insert(rows[0].end(), {measure, fmt::format("+-{:g}%", 100 * confidence)});
  }
  for (const auto& group :
       sweep::group(sofar.experiment, sofar.results, axes, measures, confidence)) {
    auto& row = rows.emplace_back(group.values);
    row.push_back(fmt::format("{}", group.finished));
    row.push_back(fmt::format("{}", group.failed));
    for (const auto& estimate : group.estimates) {
      const std::string count =
          fmt::format("n={}", estimate.count);  // where there are too few for a number
      row.insert(row.end(), {estimate.count == 0 ? count : number(estimate.mean),
                             estimate.count < 2 ? count : number(estimate.half_width)});
    }
  }
  return rows;
}

/// Writes what tasks of a cluster found into the one table, unless a sweep works on it now.
void gather(const SweepState& sofar) {
  if (!std::filesystem::exists(sofar.folder.of_tasks())) return;
  if (sweep::Lock::is_held(sofar.folder.path() / "lock")) return;
  const sweep::Lock lock(sofar.folder.path() / "lock");
  sweep::Ledger ledger(sofar.folder.ledger().string());
  std::map<std::size_t, sweep::Outcome> known;
  for (const auto& each : ledger.read()) known[each.run] = each.outcome;
  for (const auto& each : sofar.results) {
    const auto found = known.find(each.run);
    if (found == known.end() || found->second != each.outcome) ledger.write(each, sofar.experiment);
  }
  ledger.make_view(sofar.experiment);
}

/// The values of an option, several of which may stand in one text with commas between.
/// @param known  names that may have commas themselves
std::vector<std::string> split_names(const std::vector<std::string>& texts,
                                     const std::vector<std::string>& known) {
  std::vector<std::string> names;
  for (const std::string& text : texts) {
    if (std::ranges::find(known, text) != known.end()) {
      names.push_back(text);
      continue;
    }
    for (std::size_t begin = 0, end = 0; begin <= text.size(); begin = end + 1) {
      end = std::min(text.find(',', begin), text.size());
      names.push_back(text.substr(begin, end - begin));
    }
  }
  return names;
}

po::options_description results_options() {
  po::options_description options("Options", 96);
  options.add_options()                            //
      ("runs", "a row per run as CSV, not means")  //
      ("csv", "the means as CSV")                  //
      ("by", po::value<std::vector<std::string>>()->composing()->value_name("AXIS"),
       "means over all runs with the same value of this axis, or of several: a,b; default: all "
       "axes")  //
      ("metric", po::value<std::vector<std::string>>()->composing()->value_name("NAME"),
       "this metric only, or another number of runs as ticks or wall_s; may be repeated")  //
      ("confidence", po::value<std::string>()->value_name("P"), "of the intervals; default 0.95");
  return options;
}

po::options_description plot_options() {
  po::options_description options("Options", 96);
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  options.add_options()                                                                           //
      ("y", text("METRIC"), "what is averaged: a metric, or ticks, wall_s, …")                    //
      ("x", text("AXIS"), "from left to right; default: the first axis with two values or more")  //
      ("by", text("AXIS"), "a curve for each value of this axis")                                 //
      ("confidence", text("P"), "of the error bars; default 0.95")                                //
      ("file", text("FILE.svg"),
       "the picture; default: METRIC.svg in the folder; -: that one, and on stdout");
  return options;
}

std::size_t usual_abscissa(const sweep::Experiment& experiment) {
  const auto found = std::ranges::find_if(experiment.axes,
                                          [](const auto& axis) { return axis.values.size() > 1; });
  if (found != experiment.axes.end()) {
    return static_cast<std::size_t>(found - experiment.axes.begin());
  }
  throw text::UsageError(
      "the sweep has no axis with two values or more, so no axis can go "
      "from left to right");
}

/// Files that belong to the sweep or that it was made of. A picture in its folder may be replaced.
std::vector<outputs::TakenFile> taken_by(const SweepState& sofar) {
  std::vector<outputs::TakenFile> taken;
  for (const auto& [path, hash] : sofar.scene_files)
    taken.push_back({path, "a file of the sweep's scene"});
  std::error_code error;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(sofar.folder.path(), error)) {
    if (!entry.is_regular_file(error) || entry.path().extension() == ".svg") continue;
    taken.push_back({entry.path().string(), "a file that the sweep is kept in"});
  }
  return taken;
}

}  // namespace

int sweep_status(const Arguments& arguments) {
  const Parsed parsed = parse(arguments, po::options_description());
  const SweepState sofar = look("status", parsed);
  reports::Console console;
  const std::size_t total = run_count(sofar.experiment);
  std::vector<sweep::Result> failed;
  std::ranges::copy_if(sofar.results, std::back_inserter(failed),
                       [](const auto& each) { return each.outcome != sweep::Outcome::finished; });
  const bool works = sweep::Lock::is_held(sofar.folder.path() / "lock");
  console.result(fmt::format("{} of {} runs are done, {} of them failed{}", sofar.results.size(),
                             total, failed.size(), works ? "; a sweep works on the others" : ""));
  constexpr std::size_t most = 20;
  for (std::size_t i = 0; i < std::min(most, failed.size()); ++i) {
    console.result(fmt::format("  run {}: {}, exit code {}: {}", failed[i].run,
                               to_text(failed[i].outcome), failed[i].exit_code,
                               sofar.folder.log_of(failed[i].run).string()));
  }
  if (failed.size() > most) console.result(fmt::format("  and {} more", failed.size() - most));
  const auto queued = sweep::slurm_status(sofar.folder);
  if (queued) console.result(*queued);
  if (sofar.results.size() < total && !works && !queued) {
    console.result(fmt::format("to go on: ziggurat sweep resume {}",
                               text::shell_word(parsed.positional.front())));
  }
  console.flush();
  return exit_code::finished;
}

int sweep_results(const Arguments& arguments) {
  const Parsed parsed = parse(arguments, results_options());
  const Values values(parsed.values);
  check_apart(values, "runs", {"by", "metric", "confidence", "csv"});
  const SweepState sofar = look("results", parsed);
  sofar.folder.write_csv(sofar.experiment, sofar.results);
  gather(sofar);
  reports::Console console;
  if (values.has("runs")) {
    std::string csv = to_csv(sofar.experiment, sofar.results);
    csv.pop_back();
    console.result(csv);
    console.flush();
    return exit_code::finished;
  }
  std::vector<std::size_t> axes(sofar.experiment.axes.size());
  std::iota(axes.begin(), axes.end(), std::size_t{0});
  if (values.has("by")) {
    axes.clear();
    std::vector<std::string> known;
    for (const auto& axis : sofar.experiment.axes) known.push_back(axis.name);
    for (const auto& name : split_names(values.texts("by"), known)) {
      axes.push_back(axis_named(sofar.experiment, name));
    }
  }
  std::vector<std::string> measures = usual_measures(sofar.results);
  if (values.has("metric")) {
    const auto known = sweep::measures_of(sofar.results);
    measures = split_names(values.texts("metric"), known);
    for (const auto& name : measures) check_measure(name, known);
  }
  const Rows rows = table_of_means(sofar, axes, measures, confidence_of(values));
  console.result(values.has("csv") ? as_csv(rows) : aligned(rows));
  if (rows.size() == 1) console.notice("no run is done yet: there are no means (n=0)");
  console.flush();
  return exit_code::finished;
}

int sweep_plot(const Arguments& arguments) {
  const Parsed parsed = parse(arguments, plot_options());
  const Values values(parsed.values);
  const SweepState sofar = look("plot", parsed);
  sweep::Plot plot;
  plot.confidence = confidence_of(values);
  plot.x = values.has("x") ? axis_named(sofar.experiment, values.text("x"))
                           : usual_abscissa(sofar.experiment);
  if (values.has("by")) plot.series = axis_named(sofar.experiment, values.text("by"));
  const auto usual = usual_measures(sofar.results);
  if (values.has("y")) {
    plot.measure = check_measure(values.text("y"), sweep::measures_of(sofar.results));
  } else if (usual.size() == 1) {
    plot.measure = usual.front();
  } else {
    throw text::UsageError(fmt::format("what to plot? Write --y METRIC, as --y {}; known here: {}",
                                       usual.front(),
                                       fmt::join(sweep::measures_of(sofar.results), ", ")));
  }
  std::string name = plot.measure;
  std::ranges::replace(name, '/', '_');
  const bool to_stdout = values.text("file") == "-";
  const auto file = values.has("file") && !to_stdout ? std::filesystem::path(values.text("file"))
                                                     : sofar.folder.path() / (name + ".svg");
  const auto taken = taken_by(sofar);
  outputs::check_output({"--file", file.string(), {".svg"}}, taken);
  const std::string svg = to_svg(sofar.experiment, sofar.results, plot);
  sweep::write_file(file, svg);
  if (to_stdout) {
    outputs::OutputFile out("-");
    out.buffer().append(svg);
    out.close();
    return exit_code::finished;
  }
  reports::Console console;
  console.result(file.string());
  console.flush();
  return exit_code::finished;
}

}  // namespace ziggurat::cli
