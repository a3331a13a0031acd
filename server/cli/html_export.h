// SPDX-License-Identifier: MIT
#pragma once
// `ziggurat export --html`: the page with a recording inside, as one file.

#include <cstdint>
#include <string>
#include <string_view>

#include "recording/mcap/reader.h"

namespace ziggurat::cli {

/// The letters of RFC 4648, with `=` at the end.
std::string to_base64(std::string_view bytes);

/// Writes a page that plays the recording, without a server or a network: its messages without
/// those that the page does not show, /state and the topics for other viewers. It appears under its
/// name when it is whole.
/// @param player     the page without recording, as the build makes it: player.html
/// @param name       of the recording, which the page tells
/// @param out        is replaced; `-` is stdout
/// @return  its size [bytes]
/// @throws std::runtime_error  a sentence: the page was not built, the recording is too large, or a
/// file can't be read or written
std::uint64_t export_html(const std::string& player, const std::string& name,
                          const mcap::Reader& recording, const std::string& out);

}  // namespace ziggurat::cli
