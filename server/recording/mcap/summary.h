// SPDX-License-Identifier: MIT
#pragma once
// The end of a file: the summary and the footer.

#include <cstdint>
#include <string>

#include "recording/mcap/contents.h"
#include "recording/mcap/source.h"

namespace ziggurat::mcap {

struct Summary {
  std::uint64_t start = 0;  ///< offset; what is before it is the data section
  Contents contents;        ///< without header
};

/// @throws Damaged if the file has no end, or no summary, or a damaged one
Summary read_summary(const Source& source, const Limits& limits);

}  // namespace ziggurat::mcap
