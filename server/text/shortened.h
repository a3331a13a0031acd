#pragma once
// Long texts of others in a message: a part that tells which text is meant.

#include <cstddef>
#include <string>
#include <string_view>

namespace ziggurat::text {

/// The text's beginning with `…` behind it, if it has more than `most` bytes; of UTF-8 whole characters.
std::string shortened(std::string_view text, std::size_t most = 100);

/// The same for a whole message that quotes others: of words, between white space, with more than 160 bytes, and of
/// all with more than 4000, the beginning and the end stay, with `…` between.
std::string shortened_message(std::string_view message);

}  // namespace ziggurat::text
