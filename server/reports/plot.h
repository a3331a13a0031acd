#pragma once
// A plot as a picture: curves over a logarithmic abscissa, in SVG.

#include <string>
#include <vector>

namespace ziggurat::reports {

struct Curve {
  std::string name;
  std::string color;  ///< of SVG
  bool dashed = false;
  std::vector<double> y;  ///< parallel to Panel::x; not finite or zero = no point there
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

/// Axes with curves: both logarithmic, |y| is drawn.
struct Panel {
  std::string title;
  std::string x_label, y_label;  ///< with units
  std::vector<double> x;         ///< > 0, ascending
  std::vector<Curve> curves;
  std::vector<Mark> marks = {};
  std::vector<Note> notes = {};
};

/// The panels one below the other.
/// @param title  a line feed begins a smaller line below it
std::string to_svg(const std::string& title, const std::vector<Panel>& panels);

}  // namespace ziggurat::reports
