// SPDX-License-Identifier: MIT
#include "program/file_share.h"

#include <sys/resource.h>

#include <algorithm>

#include "script/open_files.h"

namespace ziggurat::lua {

void open_more_files() noexcept {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

std::size_t share_of_files(std::size_t scripts) noexcept {
  constexpr std::size_t others = 64;  // sockets, and a module that is read
  rlimit limit{};
  if (scripts == 0 || ::getrlimit(RLIMIT_NOFILE, &limit) != 0) return most_open_files;
  const auto all = static_cast<std::size_t>(limit.rlim_cur);
  return std::clamp<std::size_t>((all - std::min(all, others)) / scripts, 1, most_open_files);
}

}  // namespace ziggurat::lua
