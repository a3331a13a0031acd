// SPDX-License-Identifier: MIT
#pragma once
// Which files a script that is not trusted may write, by their names.

#include <filesystem>

namespace ziggurat::lua {

/// Endings of the names of data files, in lower case. `.json` is not among them. Too many programs
/// take such a file for their configuration, by its name alone.
inline constexpr const char* data_endings =
    ".csv .tsv .txt .log .dat .data .jsonl .bin .pgm .ppm .tmp";

/// Whether a name, and the one that it leads to by links, is that of data: it ends as data do, and
/// no program that we know takes a file of that name for instructions.
bool is_data_file(const std::filesystem::path& file);

}  // namespace ziggurat::lua
