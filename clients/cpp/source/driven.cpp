// SPDX-License-Identifier: MIT
#include "driven.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

namespace ziggurat {
namespace {

std::mutex mutex;
std::vector<const Driven*> all;  // of this program

}  // namespace

Driven::Driven(std::string endpoint) : endpoint_(std::move(endpoint)) {
  const std::lock_guard lock(mutex);
  all.push_back(this);
}

Driven::~Driven() {
  const std::lock_guard lock(mutex);
  std::erase(all, this);
}

void Driven::is(std::string id) {
  const std::lock_guard lock(mutex);
  id_ = std::move(id);
}

void Driven::by_this_thread() {
  if (thread_ == std::this_thread::get_id()) return;  // which alone writes its own id
  const std::lock_guard lock(mutex);
  thread_ = std::this_thread::get_id();
}

std::vector<std::string> driven_here(const std::string& endpoint) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(1);
  for (;;) {
    const bool is_late = Clock::now() >= end;
    bool may_begin = false;
    std::vector<std::string> ids;
    {
      const std::lock_guard lock(mutex);
      for (const Driven* each : all) {
        if (each->endpoint_ != endpoint || each->id_.empty()) continue;
        const bool has_begun = each->thread_ != std::thread::id();
        may_begin |= !has_begun;
        if (!has_begun || each->thread_ == std::this_thread::get_id()) ids.push_back(each->id_);
      }
    }
    if (!may_begin || is_late) return ids;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

}  // namespace ziggurat
