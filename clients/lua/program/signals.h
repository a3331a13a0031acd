// SPDX-License-Identifier: MIT
#pragma once
// SIGINT and SIGTERM end the scripts and then the program, even in an endless loop.

namespace ziggurat::lua {

/// From now on the first such signal interrupts scripts (see script/interrupt.h); the program has
/// a few seconds of wall time to leave the run. A second signal, or the end of that time, ends the
/// process at once.
void handle_signals();

/// The signal that arrived; 0 if none did.
int arrived_signal() noexcept;

}  // namespace ziggurat::lua
