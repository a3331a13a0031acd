// SPDX-License-Identifier: MIT
#pragma once
// Files of the checkout that tests read. No other source is compiled with an absolute path: so a
// compiler cache knows the sources of every clone.

#include <filesystem>

namespace ziggurat {

/// The folder of the checkout that was built, absolute.
std::filesystem::path checkout();

}  // namespace ziggurat
