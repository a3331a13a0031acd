// SPDX-License-Identifier: MIT
#include "processes/limits.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <stdexcept>

namespace ziggurat::processes {
namespace {

struct Need {
  decltype(RLIMIT_NOFILE) resource;
  rlim_t least;
  rlim_t unit;  ///< of ulimit, in which `least` is printed
  const char* name;
  const char* option;  ///< of ulimit
};

constexpr rlim_t kibibyte = 1024;
constexpr Need needs[] = {
    {RLIMIT_NOFILE, 64, 1, "open files", "-n"},
    {RLIMIT_AS, rlim_t{512} << 20, kibibyte, "KiB of address space", "-v"},
};
constexpr Need stack{RLIMIT_STACK, rlim_t{1} << 20, kibibyte, "KiB of stack", "-s"};

void check(const Need& need) {
  rlimit limit;
  if (::getrlimit(need.resource, &limit) != 0 || limit.rlim_cur >= need.least) return;
  throw std::runtime_error(
      fmt::format("the system allows this program {} {}; it needs {} or more; write: ulimit {} {}",
                  limit.rlim_cur / need.unit, need.name, need.least / need.unit, need.option,
                  need.least / need.unit));
}

}  // namespace

void allow_many_files() {
  rlimit limit;
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

void check_stack() { check(stack); }

void check_limits() {
  check_stack();
  for (const Need& need : needs) check(need);
}

}  // namespace ziggurat::processes
