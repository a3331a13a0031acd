#include "processes/limits.h"

#include <fmt/format.h>
#include <signal.h>
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
    {RLIMIT_STACK, rlim_t{1} << 20, kibibyte, "KiB of stack", "-s"},
};

}  // namespace

void allow_many_files() {
  rlimit limit;
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  (void)::setrlimit(RLIMIT_NOFILE, &limit);
}

void check_limits() {
  ::signal(SIGXFSZ, SIG_IGN);
  for (const Need& need : needs) {
    rlimit limit;
    if (::getrlimit(need.resource, &limit) != 0 || limit.rlim_cur >= need.least) continue;
    throw std::runtime_error(fmt::format(
        "the system allows this program {} {}; it needs {} or more; write: ulimit {} {}",
        limit.rlim_cur / need.unit, need.name, need.least / need.unit, need.option,
        need.least / need.unit));
  }
}

}  // namespace ziggurat::processes
