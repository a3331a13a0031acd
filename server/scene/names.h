// SPDX-License-Identifier: MIT
#pragma once
// Names: what was probably meant, and what is known elsewhere but not supported here.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "scene/problem.h"

namespace ziggurat::scene {

/// Most candidates that are compared with a name: more need not be collected.
constexpr std::size_t most_compared = 256;

/// The candidate that was probably meant, if one is near enough; the first of equally near ones.
std::optional<std::string_view> nearest(std::string_view name,
                                        std::span<const std::string_view> candidates);

/// `did you mean "x"?`, otherwise `known here: a, b, c`, otherwise `none is known here`.
std::string advice(std::string_view name, std::span<const std::string_view> candidates);
std::string advice(std::string_view name, const std::vector<std::string>& candidates);
/// `known here: a, b, c`, otherwise `none is known here`.
std::string list_known(std::span<const std::string_view> candidates);

/// The element that an element belongs in, if there is only one of that name.
std::optional<std::string_view> home_of(std::string_view element);

/// For Report::left_out: an id that is taken already, so that its element has no name.
constexpr std::string_view duplicate = "a duplicate";
/// The cause of faults because a joint has no known type.
constexpr std::string_view joint_type = "the type of a joint";

/// Why an element known elsewhere is not supported here, or nothing if the name means nothing.
std::optional<std::string_view> unsupported_element(std::string_view name);

/// The robot that a sensor or actuator of that name belongs to, if it is one that does not exist
/// here.
std::optional<std::string_view> robot_of_device(std::string_view name);

/// The element that has an attribute which others are given by mistake.
std::optional<std::string_view> home_of_attribute(std::string_view attribute);

/// The ids of siblings: finds duplicates and numbers the unnamed.
class Ids {
 public:
  /// False if the id is taken already.
  /// @param where  of the element that has it
  bool add(const std::string& id, Location where = {}) { return used_.emplace(id, where).second; }
  /// The element that has a taken id.
  Location owner(const std::string& id) const { return used_.at(id); }

  /// Takes and returns `<stem>_<N>` with the lowest N that is free; the same stem every time.
  std::string next(std::string_view stem, Location where = {});

 private:
  std::unordered_map<std::string, Location> used_;
  std::size_t lowest_ = 0;
};

}  // namespace ziggurat::scene
