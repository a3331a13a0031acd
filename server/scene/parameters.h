// SPDX-License-Identifier: MIT
#pragma once
// Parameters of a scene: `<parameters gain="0.5"/>` declares them with their usual values,
// `--param` gives others, and `${gain}` in any attribute stands for the value.

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scene/values.h"

namespace ziggurat::scene {

struct Parameter {
  std::string name, value;
  bool given = false;  ///< by the command line: otherwise as the scene declares it
};

/// In the order of their declaration, found by name.
class Parameters {
 public:
  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size(); }
  auto begin() const { return list_.begin(); }
  auto end() const { return list_.end(); }

  /// The parameter of that name, or null.
  const Parameter* find(std::string_view name) const;
  /// While they are declared, none can be used.
  void set_open(bool is_open) { is_open_ = is_open; }
  bool is_open() const { return is_open_; }
  /// Declares a parameter; the first of several with the same name counts.
  void declare(std::string name, std::string value);
  /// A value of the command line. @returns whether a parameter has that name
  bool give(std::string_view name, std::string value);

 private:
  std::vector<Parameter> list_;
  bool is_open_ = false;
  std::unordered_map<std::string, std::size_t> index_;  ///< by name; only looked up
};

/// Names and values, as of <params>.
using Params = std::vector<std::pair<std::string, std::string>>;

/// Value of an attribute's text: each `${name}` is replaced, and `$${` is `${`.
Value<std::string> expand(std::string_view text, const Parameters& parameters);

/// Parameters of a controller. Values of the command line replace those of its <params>; the other
/// parameters follow.
Params with_parameters(Params params, const Parameters& parameters);

}  // namespace ziggurat::scene
