// SPDX-License-Identifier: MIT
#pragma once
// Experiment of a sweep: a scene, a grid of values and seeds. Each combination is one run.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ziggurat::sweep {

/// Something that differs from run to run.
struct Axis {
  enum class Kind {
    parameter,  ///< of the scene's <parameters>, as of `run --param`
    setting,    ///< attributes of the scene that an XPath names, as of `run --set`
  };
  Kind kind = Kind::parameter;
  std::string name;                 ///< of the parameter, or the XPath
  std::vector<std::string> values;  ///< as in a scene file; at least one, each once
};

struct Experiment {
  std::string scene;                       ///< absolute path
  std::vector<Axis> axes;                  ///< the first one changes most slowly
  std::vector<std::uint64_t> seeds;        ///< change fastest; from 1 to 2^63 - 1, each once
  std::vector<std::string> run_arguments;  ///< further arguments of each `ziggurat run`
};

/// The number of runs: all values of all axes, with all seeds.
std::size_t run_count(const Experiment& experiment);

struct Combination {
  std::size_t run = 0;              ///< from 1 to run_count()
  std::vector<std::string> values;  ///< parallel to Experiment::axes
  std::uint64_t seed = 0;
};
/// @param run  from 1 to run_count()
Combination combination(const Experiment& experiment, std::size_t run);

/// `gain=0.5|1|2`, or `PATH=A|B`; `\|` is a bar in a value. @throws text::UsageError
Axis to_axis(Axis::Kind kind, std::string_view text);

/// `1..100`, `7`, or several of them: `1..10,20`. @throws text::UsageError
/// @param place  of the text, for messages: `--seeds`
std::vector<std::uint64_t> to_seeds(std::string_view place, std::string_view text);

/// @throws text::UsageError if there are no runs or too many, a name or a value is there twice, or
/// a seed can't be used
void check(const Experiment& experiment);

}  // namespace ziggurat::sweep
