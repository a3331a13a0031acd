// SPDX-License-Identifier: MIT
#include "network/barrier/deadlines.h"

#include <algorithm>
#include <utility>

namespace ziggurat::network {

using scene::DeadlineAction;

namespace {

Consequence consequence_of(const scene::DeadlinePolicy& policy, std::uint32_t misses_in_row) {
  const bool is_beyond = misses_in_row > policy.miss_budget;
  switch (policy.action) {
    case DeadlineAction::wait:
      return Consequence::none;
    case DeadlineAction::hold:
      return policy.miss_budget > 0 && is_beyond ? Consequence::drop : Consequence::none;
    case DeadlineAction::zero:
      return policy.miss_budget > 0 && is_beyond ? Consequence::drop : Consequence::zero;
    case DeadlineAction::drop:
      return is_beyond ? Consequence::drop : Consequence::none;
    case DeadlineAction::stop:
      return is_beyond ? Consequence::stop : Consequence::none;
  }
  return Consequence::none;
}

}  // namespace

std::optional<scene::DeadlinePolicy> fixed_against(const Config::Deadline& deadline,
                                                   const scene::DeadlinePolicy& requested) {
  if (!deadline.is_fixed || deadline.policy == requested) return std::nullopt;
  return deadline.policy;
}

Deadlines::Deadlines(std::vector<Config::Deadline> policies, std::size_t controllers)
    : defaults_(std::move(policies)), missed_ticks_(controllers), last_missed_(controllers) {
  defaults_.resize(controllers);
}

void Deadlines::add(std::size_t controller) {
  robots_.push_back({controller, defaults_[controller].policy, 0, {}, false});
}

void Deadlines::grow(const Config::Deadline& deadline) {
  defaults_.push_back(deadline);
  missed_ticks_.push_back(0);
  last_missed_.emplace_back();
  add(defaults_.size() - 1);
}

void Deadlines::set_policy(std::size_t robot, const std::optional<scene::DeadlinePolicy>& policy) {
  Robot& one = robots_[robot];
  one.policy = policy.value_or(defaults_[one.controller].policy);
}

std::optional<scene::DeadlinePolicy> Deadlines::fixed_against(
    std::size_t robot, const scene::DeadlinePolicy& requested) const {
  return network::fixed_against(defaults_[robots_[robot].controller], requested);
}

Consequence Deadlines::miss(std::size_t robot, std::uint64_t tick) {
  Robot& one = robots_[robot];
  if (one.last_missed != tick) ++one.misses_in_row;
  one.last_missed = tick;
  if (last_missed_[one.controller] != tick) {
    last_missed_[one.controller] = tick;
    ++missed_ticks_[one.controller];
  }
  const Consequence consequence = consequence_of(one.policy, one.misses_in_row);
  one.is_zeroed = consequence == Consequence::zero;
  return consequence;
}

void Deadlines::reset() {
  for (Robot& robot : robots_) {
    robot.misses_in_row = 0;
    robot.last_missed.reset();
    robot.is_zeroed = false;
  }
  std::ranges::fill(last_missed_, std::nullopt);
}

}  // namespace ziggurat::network
