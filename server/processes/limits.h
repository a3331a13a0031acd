#pragma once
// The limits that the system sets for this process (ulimit).

namespace ziggurat::processes {

/// Raises the limit of open files as far as allowed: each connection is an open file, and the usual
/// 1024 are fewer than the sessions that the protocol promises.
void allow_many_files();

/// Libraries abort where a limit stops them, so each is compared with the least that a run needs.
/// Files that grow too large become errors of write().
/// @throws std::runtime_error that names the limit, what a run needs and what to write
void check_limits();

}  // namespace ziggurat::processes
