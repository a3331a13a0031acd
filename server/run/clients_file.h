#pragma once
// Who can change the file of --curve-clients decides who may connect.

#include <sys/types.h>

#include <string>

namespace ziggurat::run {

/// That no other user than the one who starts the program, and root, can change the file or put another one in its place. A file
/// that can't be read is no fault here.
/// @param path  may be empty
/// @param user  who starts the program
/// @throws text::UsageError
void check_clients(const std::string& path, uid_t user);

}  // namespace ziggurat::run
