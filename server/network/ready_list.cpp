// SPDX-License-Identifier: MIT
#include "network/ready_list.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace ziggurat::network {
namespace {

epoll_event event_of(std::uint64_t id, ReadyList::Wanted wanted) {
  epoll_event event{};
  event.events = (wanted.read ? EPOLLIN | EPOLLRDHUP : 0U) | (wanted.write ? EPOLLOUT : 0U);
  event.data.u64 = id;
  return event;
}

}  // namespace

ReadyList::ReadyList() : epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
  if (!epoll_.is_open()) throw std::system_error(errno, std::generic_category(), "epoll_create1");
}

void ReadyList::add(int descriptor, std::uint64_t id, Wanted wanted) {
  epoll_event event = event_of(id, wanted);
  ::epoll_ctl(number(), EPOLL_CTL_ADD, descriptor, &event);
}

void ReadyList::change(int descriptor, std::uint64_t id, Wanted wanted) {
  epoll_event event = event_of(id, wanted);
  ::epoll_ctl(number(), EPOLL_CTL_MOD, descriptor, &event);
}

void ReadyList::remove(int descriptor) {
  ::epoll_ctl(number(), EPOLL_CTL_DEL, descriptor, nullptr);
}

bool ReadyList::look() {
  if (has_more()) return true;
  next_ = 0;
  count_ = std::max(0, ::epoll_wait(number(), events_.data(), static_cast<int>(events_.size()), 0));
  return has_more();
}

std::optional<ReadyList::Ready> ReadyList::next() {
  if (!look()) return std::nullopt;
  const epoll_event& event = events_[static_cast<std::size_t>(next_++)];
  const std::uint32_t events = event.events;
  return Ready{event.data.u64, (events & ~EPOLLOUT) != 0, (events & EPOLLOUT) != 0,
               (events & (EPOLLRDHUP | EPOLLHUP | EPOLLERR)) != 0};
}

}  // namespace ziggurat::network
