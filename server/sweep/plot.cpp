#include "sweep/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <system_error>
#include <vector>

#include "processes/child_process.h"
#include "processes/private_folder.h"
#include "sweep/folder.h"
#include "sweep/means.h"
#include "text/numbers.h"
#include "text/printable.h"
#include "text/shortened.h"

namespace ziggurat::sweep {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line =
    "# Written by ziggurat sweep plot, which replaces it: copy it before you change it.\n";

void check_is_written_here(const fs::path& script) {
  std::error_code error;
  const auto status = fs::status(script, error);
  if (!fs::exists(status)) return;
  if (fs::is_regular_file(status) && read_file(script).starts_with(first_line)) return;
  throw text::UsageError(
      fmt::format("'{}' is there and was not written by sweep plot: the program of gnuplot would "
                  "replace it; move it, or name another picture with --file",
                  script.string()));
}

/// A text as gnuplot writes it: between single quotes, which are doubled inside.
std::string in_single_quotes(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += c;
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + "'";
}

/// One that a reader sees, of a scene or a script.
std::string shown(std::string_view text) { return in_single_quotes(text::printable(text)); }

bool is_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && std::isfinite(value);
}

/// Positions of an axis' values: as numbers, otherwise side by side.
struct Abscissa {
  bool is_numeric = false;
  const std::vector<std::string>& values;

  explicit Abscissa(const Axis& axis)
      : is_numeric(std::ranges::all_of(axis.values, is_number)), values(axis.values) {}

  double of(const std::string& value) const {
    if (is_numeric) return std::strtod(value.c_str(), nullptr);
    return static_cast<double>(std::ranges::find(values, value) - values.begin());
  }
  /// Names below the axis; nothing for numbers.
  std::string ticks() const {
    if (is_numeric) return {};
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i) {
      text += fmt::format("{}{} {}", i == 0 ? "" : ", ", shown(values[i]), i);
    }
    return fmt::format("set xtics ({})\nset xrange [-0.5:{}]\n", text,
                       static_cast<double>(values.size()) - 0.5);
  }
};

/// The points of a curve: x, mean, half of the interval.
std::string points(std::vector<Group> groups, const Abscissa& abscissa) {
  std::erase_if(groups, [](const Group& each) { return each.estimates[0].count == 0; });
  std::ranges::sort(groups, {}, [&](const Group& each) { return abscissa.of(each.values[0]); });
  std::string text;
  for (const Group& each : groups) {
    const Estimate& estimate = each.estimates[0];
    text += fmt::format("{} {} {}\n", abscissa.of(each.values[0]), estimate.mean,
                        std::isfinite(estimate.half_width) ? estimate.half_width : 0);
  }
  return text;
}

}  // namespace

std::string gnuplot_program(const Experiment& experiment, std::span<const Result> results,
                            const Plot& plot, const fs::path& svg) {
  const Axis& x = experiment.axes[plot.x];
  const Abscissa abscissa(x);
  std::vector<std::string> names = {""};
  if (plot.series) names = experiment.axes[*plot.series].values;
  const std::vector<std::size_t> axes = {plot.x};
  const std::vector<std::string> measures = {plot.measure};
  std::string data, curves;
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::vector<Result> of_curve;
    std::ranges::copy_if(results, std::back_inserter(of_curve), [&](const Result& result) {
      return !plot.series || combination(experiment, result.run).values[*plot.series] == names[i];
    });
    const std::string text =
        points(group(experiment, of_curve, axes, measures, plot.confidence), abscissa);
    if (text.empty()) continue;
    data += fmt::format("$curve{} << END\n{}END\n", i, text);
    const std::string title =
        plot.series ? fmt::format("{} = {}", experiment.axes[*plot.series].name, names[i]) : "";
    curves += fmt::format(
        "{} $curve{} using 1:2:3 with yerrorlines linewidth 2 pointtype 7 "
        "pointsize 0.6 {}",
        curves.empty() ? "" : ",\\\n    ", i, title.empty() ? "notitle" : "title " + shown(title));
  }
  if (curves.empty()) {
    throw text::UsageError(fmt::format("no run that finished has a value of {}", plot.measure));
  }
  const std::string label =
      fmt::format("{} (mean, {:g} % confidence)", plot.measure, 100 * plot.confidence);
  return fmt::format(
      "{}set terminal svg size 800,500 dynamic font 'sans-serif,14' noenhanced background 'white'\n"
      "set output {}\nset xlabel {}\nset ylabel {}\nset grid\nset offsets graph 0.03, graph 0.03, "
      "graph 0.03, graph 0.03\nset key outside right\n{}{}plot{}\n",
      first_line, in_single_quotes(svg.string()), shown(x.name), shown(label), abscissa.ticks(),
      data, curves);
}

fs::path program_beside(const fs::path& svg) { return fs::path(svg).replace_extension(".gnuplot"); }

void draw(const Experiment& experiment, std::span<const Result> results, const Plot& plot,
          const fs::path& svg) {
  const std::string program = gnuplot_program(experiment, results, plot, svg);
  const fs::path script = program_beside(svg);
  check_is_written_here(script);
  write_file(script, program);
  const processes::PrivateFolder folder;
  const fs::path log = fs::path(folder.path()) / "gnuplot.log";
  try {
    // Its whole path: a name may begin with a dash.
    processes::ChildProcess gnuplot({{"gnuplot", fs::absolute(script).string()}, {}, log.string()});
    processes::end_all({&gnuplot}, 60'000, [] { return false; });
    if (!gnuplot.ended_well()) {
      throw text::UsageError(
          fmt::format("gnuplot {}: {}", gnuplot.how_it_ended(), text::trimmed(read_file(log))));
    }
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::no_such_file_or_directory) throw;
    throw text::UsageError(
        fmt::format("plots need gnuplot, which is not installed; on Debian: apt-get install "
                    "gnuplot-nox, then this command again. Its program is in {}",
                    script.string()));
  }
}

}  // namespace ziggurat::sweep
