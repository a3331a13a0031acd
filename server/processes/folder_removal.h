#pragma once
// Removal of a folder that holds a lock: at each moment it has its lock, or nothing else.

#include <string>

namespace ziggurat::processes {

inline constexpr const char* lock_name = "lock";

/// Removes a folder with everything in it, at last its lock and itself. It stays if something can't
/// be removed.
void remove_locked_folder(const std::string& folder) noexcept;

}  // namespace ziggurat::processes
