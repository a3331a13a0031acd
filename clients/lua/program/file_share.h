#pragma once
// What this process may open, shared among its robots.

#include <cstddef>

namespace ziggurat::lua {

/// Lets the process open as many files as its hard limit allows.
void open_more_files() noexcept;

/// How many files each of so many scripts may have open, so that all together leave some for the rest.
std::size_t share_of_files(std::size_t scripts) noexcept;

}  // namespace ziggurat::lua
