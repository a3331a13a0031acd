#pragma once
// Removal of a folder that holds a lock: at each moment it has its lock, or nothing else.

#include <chrono>
#include <string>

namespace ziggurat::processes {

inline constexpr const char* lock_name = "lock";

/// Removes a folder with everything in it, at last its lock and itself. Again and again if something is put into it
/// meanwhile, for that time at most.
/// @returns whether it is gone
bool remove_locked_folder(const std::string& folder, std::chrono::milliseconds patience) noexcept;

}  // namespace ziggurat::processes
