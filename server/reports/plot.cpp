// SPDX-License-Identifier: MIT
#include "reports/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "text/printable.h"

namespace ziggurat::reports {
namespace {

constexpr double left = 80, plot_width = 620, right = 20, top = 50, bottom = 50;  // [px]
constexpr double legend_line = 18, character = 6.5;                               // [px]

double scaled(Scale scale, double value) {
  return scale == Scale::logarithmic ? std::log10(std::abs(value)) : value;
}

bool drawable(Scale scale, double y) { return std::isfinite(scaled(scale, y)); }

/// From a range of values to one of pixels.
struct Mapping {
  Scale scale;
  double low, high;  // scaled
  double from, to;   // [px]

  double operator()(double value) const {
    return from + (scaled(scale, value) - low) / (high - low) * (to - from);
  }
};

struct Range {
  double low = HUGE_VAL, high = -HUGE_VAL;

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// Adds some on both sides, so that points do not lie on the frame.
  void widen() {
    const double room = high > low ? 0.03 * (high - low) : std::max(std::abs(high), 1.0) / 2;
    low -= room;
    high += room;
  }
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text::printable(text)) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

std::string label(double x, double y, const std::string& text, const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", x, y, more, escaped(text));
}

/// Values with a grid line: 1, 2, 5 of each decade, or only 1 of many; or about six round numbers.
std::vector<double> ticks(const Mapping& axis) {
  std::vector<double> found;
  const auto add = [&](double value) {
    const double at = scaled(axis.scale, value);
    if (at > axis.low - 1e-9 && at < axis.high + 1e-9) found.push_back(value);
  };
  if (axis.scale == Scale::logarithmic) {
    for (double decade = std::floor(axis.low); decade <= axis.high; ++decade) {
      for (const int digit : {1, 2, 5}) {
        if (digit == 1 || axis.high - axis.low <= 3) add(digit * std::pow(10.0, decade));
      }
    }
    return found;
  }
  const double least = (axis.high - axis.low) / 8;
  double step = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {2.0, 2.5, 2.0}) {
    if (step < least) step *= factor;
  }
  const double last = std::floor(axis.high / step);
  for (double i = std::ceil(axis.low / step); i <= last; ++i) add(i * step);
  return found;
}

std::string grid(const Panel& panel, const Mapping& x, const Mapping& y) {
  std::string out;
  const auto draw_x = [&](double value, const std::string& name) {
    out +=
        fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", x(value), y.from, y.to);
    out += label(x(value), y.from + 18, name, "text-anchor=\"middle\"");
  };
  for (std::size_t i = 0; i < panel.x_names.size(); ++i)
    draw_x(static_cast<double>(i), panel.x_names[i]);
  if (panel.x_names.empty()) {
    for (const double value : ticks(x)) draw_x(value, fmt::format("{:g}", value));
  }
  for (const double value : ticks(y)) {
    out +=
        fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", x.from, y(value), x.to);
    out += label(left - 6, y(value) + 4, fmt::format("{:g}", value), "text-anchor=\"end\"");
  }
  return out;
}

/// Wide enough for curves and marks.
Mapping mapping_of_x(const Panel& panel) {
  Range range;
  for (const double x : panel.x) range.include(scaled(panel.scale, x));
  for (const Mark& mark : panel.marks) {
    range.include(scaled(panel.scale, mark.x * 0.9));
    range.include(scaled(panel.scale, mark.x * 1.1));
  }
  if (!panel.x_names.empty()) range = {-0.5, static_cast<double>(panel.x_names.size()) - 0.5};
  if (panel.scale == Scale::linear) range.widen();
  return {panel.scale, range.low, range.high, left, left + plot_width};
}

/// Wide enough for curves and their error bars; none if no point can be drawn.
std::optional<Mapping> mapping_of_y(const Panel& panel, double from, double to) {
  Range range;
  for (const Curve& curve : panel.curves) {
    for (std::size_t i = 0; i < curve.y.size(); ++i) {
      if (!drawable(panel.scale, curve.y[i])) continue;
      const double spread = curve.spread.empty() ? 0 : curve.spread[i];
      range.include(scaled(panel.scale, curve.y[i] - spread));
      range.include(scaled(panel.scale, curve.y[i] + spread));
    }
  }
  if (range.low > range.high) return {};
  if (panel.scale == Scale::linear) {
    range.widen();
  } else {
    range.low = std::floor(range.low);
    range.high = std::max(std::ceil(range.high), range.low + 1);
  }
  return Mapping{panel.scale, range.low, range.high, from, to};
}

std::string marks(const Panel& panel, const Mapping& x, const Mapping& y) {
  std::string out;
  double height = y.from - 8;  // of the name: above the axis, each above the one before
  for (const Mark& mark : panel.marks) {
    const double at = x(mark.x);
    const bool is_right = at > left + plot_width / 2;
    out += fmt::format(
        "<line class=\"mark\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" "
        "stroke=\"{3}\" stroke-width=\"1.5\" stroke-dasharray=\"4 3\"/>\n",
        at, y.from, y.to, mark.color);
    out +=
        label(at + (is_right ? -5 : 5), height, mark.name,
              fmt::format("fill=\"{}\" text-anchor=\"{}\"", mark.color, is_right ? "end" : "start")
                  .c_str());
    height -= 16;
  }
  return out;
}

std::string notes(const Panel& panel, double offset) {
  std::string out;
  double y = offset + top + 16;
  for (const Note& note : panel.notes) {
    out += label(left + 10, y, note.text, fmt::format("fill=\"{}\"", note.color).c_str());
    y += 16;
  }
  return out;
}

std::string stroke(const Curve& curve) {
  return fmt::format("stroke=\"{}\"{}", curve.color,
                     curve.dashed ? " stroke-dasharray=\"7 5\"" : "");
}

/// Points as a line with gaps; those with error bars as dots, too.
std::string draw(const Panel& panel, const Curve& curve, const Mapping& x, const Mapping& y) {
  std::string line, dots;
  bool pen_down = false;
  for (std::size_t i = 0; i < panel.x.size(); ++i) {
    const bool is_point = drawable(panel.scale, curve.y[i]);
    if (is_point) {
      const double at = x(panel.x[i]), height = y(curve.y[i]);
      line += fmt::format("{}{:.1f} {:.1f} ", pen_down ? "L" : "M", at, height);
      if (!curve.spread.empty()) {
        dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" fill=\"{}\"/>\n", at,
                            height, curve.color);
        for (const double end : {y(curve.y[i] - curve.spread[i]), y(curve.y[i] + curve.spread[i])})
          line += fmt::format("M{0:.1f} {1:.1f}V{2:.1f}h-4h8M{0:.1f} {1:.1f}", at, height, end);
      }
    }
    pen_down = is_point;
  }
  if (line.empty()) return {};
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke-width=\"2\" {}/>\n{}", line,
                     stroke(curve), dots);
}

double height_of(const Panel& panel) {
  return std::max(340.0, top + bottom + legend_line * static_cast<double>(panel.curves.size()));
}

/// Pixels beside the axes, enough for the longest name.
double legend_width(const std::vector<Panel>& panels) {
  std::size_t longest = 0;
  for (const Panel& panel : panels) {
    for (const Curve& curve : panel.curves)
      longest = std::max(longest, text::printable(curve.name).size());
  }
  return longest == 0 ? 0 : 48 + character * static_cast<double>(longest);
}

std::string draw(const Panel& panel, double offset) {
  std::string out = label(left, offset + 24, panel.title, "font-weight=\"bold\"");
  const double floor = offset + height_of(panel) - bottom;
  out += label(left + plot_width / 2, floor + 40, panel.x_label, "text-anchor=\"middle\"");
  out += notes(panel, offset);
  const auto y = mapping_of_y(panel, floor, offset + top);
  if (!y) return out + label(left + 20, offset + top + 40, "zero everywhere");
  const Mapping x = mapping_of_x(panel);
  out += grid(panel, x, *y) + label(8, offset + top - 8, panel.y_label);
  out += marks(panel, x, *y);
  double legend = offset + top + 16;
  for (const Curve& curve : panel.curves) {
    const std::string drawn = draw(panel, curve, x, *y);
    out += drawn;
    if (drawn.empty() || curve.name.empty()) continue;
    out += fmt::format("<path d=\"M{} {}h26\" stroke-width=\"2\" {}/>\n", x.to + 10, legend - 4,
                       stroke(curve));
    out += label(x.to + 44, legend, curve.name);
    legend += legend_line;
  }
  return out;
}

}  // namespace

std::string to_svg(const std::string& title, const std::vector<Panel>& panels) {
  const auto line_feed = title.find('\n');
  double height = title.empty() ? 0 : line_feed == std::string::npos ? 30 : 44;
  std::string out;
  if (!title.empty()) out += label(left, 20, title.substr(0, line_feed), "font-size=\"15\"");
  if (line_feed != std::string::npos) out += label(left, 38, title.substr(line_feed + 1));
  for (const Panel& panel : panels) {
    out += draw(panel, height);
    height += height_of(panel);
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1}\" viewBox=\"0 0 "
      "{0:.0f} "
      "{1}\" font-family=\"sans-serif\" font-size=\"12\">\n<style>.grid{{stroke:#ddd}}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{2}</svg>\n",
      left + plot_width + right + legend_width(panels), height, out);
}

}  // namespace ziggurat::reports
