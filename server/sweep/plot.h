#pragma once
// Means with error bars as a picture, drawn by gnuplot.

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "sweep/experiment.h"
#include "sweep/result.h"

namespace ziggurat::sweep {

struct Plot {
  std::size_t x = 0;                  ///< the axis from left to right: into Experiment::axes
  std::optional<std::size_t> series;  ///< a curve for each value of this axis
  std::string measure;                ///< from bottom to top
  double confidence = 0.95;           ///< of the error bars, in (0, 1)
};

/// A program for gnuplot that writes an SVG file.
std::string gnuplot_program(const Experiment& experiment, std::span<const Result> results,
                            const Plot& plot, const std::filesystem::path& svg);

/// Path of the program for gnuplot that draws a picture: the ending is .gnuplot.
std::filesystem::path program_beside(const std::filesystem::path& svg);

/// Writes the picture, and the program for gnuplot beside it.
/// @throws text::UsageError if gnuplot is missing or fails, or a file of another origin stands
/// where the program would
void draw(const Experiment& experiment, std::span<const Result> results, const Plot& plot,
          const std::filesystem::path& svg);

}  // namespace ziggurat::sweep
