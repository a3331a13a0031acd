// SPDX-License-Identifier: MIT
#include "network/awake_wait.h"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <thread>

namespace ziggurat::network {
namespace {

constexpr unsigned longest_pause = 63;

}  // namespace

AwakeWait::AwakeWait(std::size_t processors, const std::string& load)
    : processors_(processors), load_(::open(load.c_str(), O_RDONLY | O_CLOEXEC)) {}

std::size_t AwakeWait::usable_processors() {
  cpu_set_t set;
  if (::sched_getaffinity(0, sizeof set, &set) == 0)
    return static_cast<std::size_t>(CPU_COUNT(&set));
  return std::thread::hardware_concurrency();
}

bool AwakeWait::is_worth_it(std::size_t awaited) {
  if (!load_.is_open() || awaited == 0 || awaited >= processors_) return false;
  if (left_ == 0) return true;
  --left_;
  return false;
}

/// "0.52 0.48 0.50 3/812 4711": three of 812 threads run or are ready.
bool AwakeWait::is_crowded() const {
  char text[64];
  const ssize_t size = ::pread(load_.number(), text, sizeof text, 0);
  if (size <= 0) return true;
  const std::string_view words(text, static_cast<std::size_t>(size));
  const std::size_t slash = words.find('/');
  if (slash == std::string_view::npos) return true;
  const std::size_t begin = words.rfind(' ', slash) + 1;
  std::size_t ready = 0;
  const auto read = std::from_chars(words.data() + begin, words.data() + slash, ready);
  return read.ec != std::errc{} || ready > processors_;
}

bool AwakeWait::succeed() {
  pause_ = 0;
  return true;
}

bool AwakeWait::fail(bool is_crowded) {
  pause_ = is_crowded ? longest_pause : std::min(2 * pause_ + 1, longest_pause);
  left_ = pause_;
  return false;
}

}  // namespace ziggurat::network
