#pragma once
// Parameters of a scene: `<parameters gain="0.5"/>` declares them with their usual values, `--param`
// gives others, and `${gain}` in any attribute stands for the value.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/values.h"

namespace ziggurat::scene {

struct Parameter {
  std::string name, value;
  bool given = false;  ///< by the command line: otherwise as the scene declares it
};

/// In the order of their declaration.
using Parameters = std::vector<Parameter>;
/// Names and values, as of <params>.
using Params = std::vector<std::pair<std::string, std::string>>;

/// What an attribute's text means: each `${name}` replaced, and `$${` is `${`.
Value<std::string> expand(std::string_view text, const Parameters& parameters);

/// What a controller gets: its <params>, with what the command line gives for the same names, and
/// the other parameters behind them.
Params with_parameters(Params params, const Parameters& parameters);

}  // namespace ziggurat::scene
