// SPDX-License-Identifier: MIT
#pragma once
// stdout and stderr of scripts: printable unless scripts are trusted, and never in the way of a
// tick.

namespace ziggurat::lua {

/// From now on C's stdout and stderr, to which Lua's print and io.write write, do not wait for a
/// reader that stops: up to 16 MiB wait in memory, then text is dropped and counted.
/// @param is_printable  control characters other than line feed and tab, which can change what a
/// terminal
///                      does, are written as `\u001b`
void take_terminal(bool is_printable);

/// Writes what waits as far as the readers take it.
void offer_to_terminal();

/// Waits until all is written.
void finish_terminal();

}  // namespace ziggurat::lua
