// SPDX-License-Identifier: MIT
#include "physics/stepping/team.h"

#include <utility>

namespace ziggurat::dynamics {
namespace {

/// Looks at a condition for some hundred microseconds: the next loop of a substep follows soon.
template <class Condition>
bool comes_true_soon(Condition is_true) {
  constexpr int looks = 20'000;
  for (int i = 0; i < looks; ++i) {
    if (is_true()) return true;
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }
  return false;
}

}  // namespace

Team::Team(unsigned threads) : parts_(threads) {
  try {
    for (unsigned member = 1; member < threads; ++member)
      workers_.emplace_back([this, member] { work(member); });
  } catch (...) {
    end();
    throw;
  }
}

Team::~Team() { end(); }

void Team::end() {
  is_over_ = true;
  state_ += 2;  // still closed
  state_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

/// Takes items of a part until none is left.
void Team::take_part(unsigned part, unsigned member) {
  Part& items = parts_[part];
  for (std::size_t item = items.next++; item < items.last; item = items.next++)
    loop_.call(loop_.body, item, member);
}

/// Takes items of the open loop until none is left.
void Team::take_items(unsigned member) {
  try {
    for (unsigned i = 0; i < size(); ++i) take_part((member + i) % size(), member);
  } catch (...) {
    for (Part& part : parts_) part.next = part.last;
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
  }
}

/// Joins each loop that it sees open. A worker counts itself before it looks again, and run()
/// counts after it has closed the loop: one of both sees the other.
void Team::work(unsigned member) {
  std::uint32_t seen = 0;
  for (;;) {
    if (!comes_true_soon([&] { return state_.load(std::memory_order_acquire) != seen; }))
      state_.wait(seen);
    seen = state_;
    if (is_over_) return;
    if (!is_open(seen)) continue;
    ++active_;
    if (state_ == seen) take_items(member);
    --active_;
    active_.notify_one();
  }
}

void Team::run(const Loop& loop) {
  loop_ = loop;
  for (unsigned i = 0; i < size(); ++i) {
    parts_[i].next = loop.count * i / size();
    parts_[i].last = loop.count * (i + 1) / size();
  }
  ++state_;
  state_.notify_all();
  take_items(0);
  ++state_;
  comes_true_soon([&] { return active_.load(std::memory_order_acquire) == 0; });
  for (std::uint32_t left = active_; left != 0; left = active_) active_.wait(left);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace ziggurat::dynamics
