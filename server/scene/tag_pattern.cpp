#include "scene/tag_pattern.h"

#include <charconv>

namespace ziggurat::scene {

std::optional<unsigned> tag_pattern(std::string_view payload) {
  constexpr unsigned ids = 587;
  unsigned id = ids;
  const auto [end, error] = std::from_chars(payload.data(), payload.data() + payload.size(), id);
  if (error != std::errc() || end != payload.data() + payload.size() || id >= ids) {
    return std::nullopt;
  }
  return id;
}

}  // namespace ziggurat::scene
