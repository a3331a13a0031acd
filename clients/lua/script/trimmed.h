// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace ziggurat::lua {

/// The text without white space at its beginning and end.
inline std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(space) + 1 - begin);
}

}  // namespace ziggurat::lua
