// SPDX-License-Identifier: MIT
#pragma once
// Texts without a part: long ones of others in a message, and white space at the ends.

#include <cstddef>
#include <string>
#include <string_view>

namespace ziggurat::text {

/// The text's beginning with `…` behind it, if it has more than `most` bytes; of UTF-8 whole
/// characters.
std::string shortened(std::string_view text, std::size_t most = 100);

/// Shortens a whole message that quotes other texts. Words of more than 160 bytes, and a message of
/// more than 4000, keep their beginning and end, with `…` between.
std::string shortened_message(std::string_view message);

/// The text without spaces, tabs and line ends at its ends.
std::string_view trimmed(std::string_view text);

}  // namespace ziggurat::text
