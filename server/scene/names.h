#pragma once
// Names: what was probably meant, and what is known elsewhere but not supported here.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace ziggurat::scene {

/// The candidate that was probably meant, if one is near enough; the first of equally near ones.
std::optional<std::string_view> nearest(std::string_view name,
                                        std::span<const std::string_view> candidates);

/// `did you mean "x"?`, otherwise `known here: a, b, c`, otherwise `remove it`.
std::string advice(std::string_view name, std::span<const std::string_view> candidates);
std::string advice(std::string_view name, const std::vector<std::string>& candidates);

/// Why an element known elsewhere is not supported here, or nothing if the name means nothing.
std::optional<std::string_view> unsupported_element(std::string_view name);

/// The same for an attribute.
std::optional<std::string_view> unsupported_attribute(std::string_view name);

/// The ids of siblings: finds duplicates and numbers the unnamed.
class Ids {
 public:
  /// False if the id is taken already.
  bool add(const std::string& id) { return used_.insert(id).second; }
  bool contains(const std::string& id) const { return used_.contains(id); }

  /// Takes and returns `<stem>_<N>` with the lowest N that is free; the same stem every time.
  std::string next(std::string_view stem);

 private:
  std::unordered_set<std::string> used_;
  std::size_t lowest_ = 0;
};

}  // namespace ziggurat::scene
