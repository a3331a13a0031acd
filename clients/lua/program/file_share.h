// SPDX-License-Identifier: MIT
#pragma once
// Share of the files that this process may open, for each of its robots.

#include <cstddef>

namespace ziggurat::lua {

/// Lets the process open as many files as its hard limit allows.
void open_more_files() noexcept;

/// Number of files that each of so many scripts may have open, so that all together leave some for
/// the rest.
std::size_t share_of_files(std::size_t scripts) noexcept;

}  // namespace ziggurat::lua
