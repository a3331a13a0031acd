#include "reports/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "text/printable.h"

namespace ziggurat::reports {
namespace {

constexpr double width = 720, panel_height = 340, left = 80, right = 20, top = 50, bottom = 50;

bool drawable(double y) { return std::isfinite(y) && y != 0; }

/// From a range of values to one of pixels, by their logarithms.
struct Scale {
  double low, high;  // decades
  double from, to;   // [px]

  double operator()(double value) const {
    return from + (std::log10(value) - low) / (high - low) * (to - from);
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

std::string grid(const Scale& x, const Scale& y, double offset) {
  std::string out;
  for (int decade = static_cast<int>(std::floor(x.low)); decade <= x.high; ++decade) {
    for (const int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10.0, decade);
      if (std::log10(value) < x.low || std::log10(value) > x.high) continue;
      const double at = x(value);
      out += fmt::format(
          "<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/>\n",
          at, y.from, y.to);
      out += label(at, offset + panel_height - bottom + 18, fmt::format("{:g}", value),
                   "text-anchor=\"middle\"");
    }
  }
  for (int decade = static_cast<int>(std::ceil(y.low)); decade <= y.high; ++decade) {
    const double at = y(std::pow(10.0, decade));
    out += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" y1=\"{2:.1f}\" x2=\"{1:.1f}\" y2=\"{2:.1f}\"/>\n",
        x.from, x.to, at);
    out += label(left - 6, at + 4, fmt::format("1e{}", decade), "text-anchor=\"end\"");
  }
  return out;
}

/// Wide enough for curves and marks.
Scale scale_of_x(const Panel& panel) {
  double low = panel.x.front(), high = panel.x.back();
  for (const Mark& mark : panel.marks) {
    low = std::min(low, mark.x * 0.9);
    high = std::max(high, mark.x * 1.1);
  }
  return {std::log10(low), std::log10(high), left, width - right};
}

std::string marks(const Panel& panel, const Scale& x, const Scale& y) {
  std::string out;
  double height = y.from - 8;  // of the name: above the axis, each above the one before
  for (const Mark& mark : panel.marks) {
    const double at = x(mark.x);
    const bool is_right = at > width / 2;
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

std::string draw(const Panel& panel, double offset) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Curve& curve : panel.curves) {
    for (const double y : curve.y) {
      if (!drawable(y)) continue;
      low = std::min(low, std::log10(std::abs(y)));
      high = std::max(high, std::log10(std::abs(y)));
    }
  }
  std::string out = label(left, offset + 24, panel.title, "font-weight=\"bold\"");
  out += label((left + width - right) / 2, offset + panel_height - 10, panel.x_label,
               "text-anchor=\"middle\"");
  out += notes(panel, offset);
  if (low > high) return out + label(left + 20, offset + top + 40, "zero everywhere");
  const Scale x = scale_of_x(panel);
  const Scale y{std::floor(low), std::max(std::ceil(high), std::floor(low) + 1),
                offset + panel_height - bottom, offset + top};
  out += grid(x, y, offset) + label(8, offset + top - 8, panel.y_label);
  out += marks(panel, x, y);
  double legend = offset + top + 16;
  for (const Curve& curve : panel.curves) {
    std::string path;
    bool pen_down = false;
    for (std::size_t i = 0; i < panel.x.size(); ++i) {
      if (!drawable(curve.y[i])) {
        pen_down = false;
        continue;
      }
      path += fmt::format("{}{:.1f} {:.1f} ", pen_down ? "L" : "M", x(panel.x[i]),
                          y(std::abs(curve.y[i])));
      pen_down = true;
    }
    if (path.empty()) continue;
    const std::string style = fmt::format("stroke=\"{}\"{}", curve.color,
                                          curve.dashed ? " stroke-dasharray=\"7 5\"" : "");
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke-width=\"2\" {}/>\n", path, style);
    out +=
        fmt::format("<line x1=\"{0}\" y1=\"{2}\" x2=\"{1}\" y2=\"{2}\" stroke-width=\"2\" {3}/>\n",
                    width - 190, width - 160, legend - 4, style);
    out += label(width - 152, legend, curve.name);
    legend += 18;
  }
  return out;
}

}  // namespace

std::string to_svg(const std::string& title, const std::vector<Panel>& panels) {
  const double head = title.find('\n') == std::string::npos ? 30 : 44;  // [px] above the panels
  const double height = head + panel_height * static_cast<double>(panels.size());
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<style>.grid{{stroke:#ddd}}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      width, height);
  const auto line_feed = title.find('\n');
  out += label(left, 20, title.substr(0, line_feed), "font-size=\"15\"");
  if (line_feed != std::string::npos) out += label(left, 38, title.substr(line_feed + 1));
  for (std::size_t i = 0; i < panels.size(); ++i)
    out += draw(panels[i], head + panel_height * static_cast<double>(i));
  return out + "</svg>\n";
}

}  // namespace ziggurat::reports
