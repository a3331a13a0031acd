// SPDX-License-Identifier: MIT
#pragma once
// The limits that the system sets for this process (ulimit).

namespace ziggurat::processes {

/// Raises the limit of open files as far as allowed: each connection is an open file, and the usual
/// 1024 are fewer than the sessions that the protocol promises.
void allow_many_files();

/// Libraries abort where a limit stops them, so each is compared with the least that is needed: the
/// stack by every command, the others by those that run a world.
/// @throws std::runtime_error that names the limit, what is needed and what to write
void check_stack();
void check_limits();

}  // namespace ziggurat::processes
