// SPDX-License-Identifier: MIT
#pragma once
// A plot as a picture in SVG: curves, error bars, axes with logarithms, numbers or names.

#include <string>
#include <vector>

namespace ziggurat::reports {

struct Curve {
  std::string name;
  std::string color;  ///< of SVG
  bool dashed = false;
  std::vector<double> y;            ///< parallel to Panel::x; where it can't be drawn, a gap
  std::vector<double> spread = {};  ///< half of the error bar at each point; empty = none
};

/// A vertical line.
struct Mark {
  double x = 0;  ///< > 0
  std::string name;
  std::string color;  ///< of SVG
};

/// A line of text above the curves.
struct Note {
  std::string text;
  std::string color;  ///< of SVG
};

/// Logarithmic axes show |y|, and zero as a gap.
enum class Scale { logarithmic, linear };

struct Panel {
  std::string title;
  std::string x_label, y_label;  ///< with units
  std::vector<double> x;         ///< ascending; logarithmic: > 0
  std::vector<Curve> curves;
  std::vector<Mark> marks = {};
  std::vector<Note> notes = {};
  Scale scale = Scale::logarithmic;       ///< of both axes
  std::vector<std::string> x_names = {};  ///< shown at 0, 1, 2, … instead of numbers; linear only
};

/// The panels one below the other.
/// @param title  a line feed begins a smaller line below it
std::string to_svg(const std::string& title, const std::vector<Panel>& panels);

}  // namespace ziggurat::reports
