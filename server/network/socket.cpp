// SPDX-License-Identifier: MIT
#include "network/socket.h"

#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <new>
#include <system_error>
#include <utility>

#include "network/endpoint.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;
using Seconds = std::chrono::duration<double>;

constexpr milliseconds linger{1000};  // what waits at the end may take this long
constexpr milliseconds tending{500};
constexpr int looks_at_once = 64;  // at what may be no message, until the caller looks at the time
constexpr int members_at_once = 64;  // until others have a look, if these never end

/// Number of descriptors for connections: an eighth of all stays for files and processes.
std::size_t descriptors_for_peers() {
  constexpr std::size_t most = 65'536, least_reserved = 48;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return most_without_session;
  const auto all = static_cast<std::size_t>(std::min<rlim_t>(limit.rlim_cur, most));
  const std::size_t reserved = std::max(least_reserved, all / 8);
  return all > reserved ? all - reserved : 1;
}

}  // namespace

Socket::Socket(const Config& config)
    : longest_(config.max_message_bytes),
      most_peers_(descriptors_for_peers()),
      most_without_session_(std::clamp(most_peers_ / 2, std::size_t{1}, most_without_session)),
      next_tending_(Clock::now()),
      share_{config.curve ? share_of_others_with_keys : share_of_others,
             Seconds(saved_share).count()},
      others_time_(share_, next_tending_) {
  if (config.curve) keys_.emplace(*config.curve);
  const bool allows_any = config.insecure || config.curve;
  for (const std::string& endpoint : config.endpoints) {
    check_endpoint(endpoint, allows_any);
    listen(endpoint, Trust::none);
  }
}

Socket::~Socket() {
  const Time end = Clock::now() + linger;
  for (;;) {
    polled_.clear();
    for (const int descriptor : peers_.flush()) polled_.push_back({descriptor, POLLOUT, 0});
    const auto rest = std::chrono::duration_cast<milliseconds>(end - Clock::now());
    if (polled_.empty() || rest.count() <= 0) return;
    ::poll(polled_.data(), polled_.size(), static_cast<int>(rest.count()));
  }
}

void Socket::add_private(const Config& config) {
  check_endpoint(config.private_endpoint, config.insecure);
  listen(config.private_endpoint, Trust::own_user);
  std::rotate(endpoints_.begin(), endpoints_.end() - 1, endpoints_.end());
}

void Socket::listen(const std::string& endpoint, Trust trust) {
  const std::uint64_t id = entrances_.size();
  const Entrance& entrance = entrances_.emplace_back(Entrance{Listener(endpoint), id, trust});
  endpoints_.push_back(entrance.listener.endpoint());
  peers_.others().add(entrance.listener.number(), id, {});
}

/// @param write  writes the content, `size` bytes
Delivery Socket::send(const std::string& connection, std::size_t size, MessageKind kind,
                      const auto& write) {
  PeerSocket* peer = peers_.find(connection);
  if (peer == nullptr || !peer->is_open()) return Delivery::unreachable;
  const std::size_t at = peer->content_at(size);
  frame_.reserve(at + size);
  write(frame_.bytes.get() + at);
  peers_.act(*peer, [&](PeerSocket& to) { to.send(frame_, size, kind); });
  return peer->is_over() ? Delivery::unreachable : Delivery::sent;
}

Delivery Socket::send(const std::string& connection, const wire::Outbox& message) {
  return send(connection, message.size(), kind_of(message),
              [&](std::uint8_t* to) { message.write(to); });
}

Delivery Socket::send(const std::string& connection, std::string_view bytes, MessageKind kind) {
  return send(connection, bytes.size(), kind,
              [&](std::uint8_t* to) { std::memcpy(to, bytes.data(), bytes.size()); });
}

void Socket::set_standing(const std::string& connection, Standing standing, std::size_t longest) {
  peers_.set_standing(connection, standing, longest, Clock::now());
  if (!is_other(standing)) other_since_.reset();  // it is none any more
  PeerSocket* peer = peers_.find(connection);
  if (peer == nullptr || !peer->has_turn) return;
  for (Group* group : {&members_, &others_}) std::erase(group->turns, connection);
  group_of(*peer).give_turn(*peer);
}

Socket::Group& Socket::group_of(const PeerSocket& peer) {
  return is_other(peer.standing()) ? others_ : members_;
}

void Socket::handled() {
  if (!other_since_) return;
  const Seconds used = ThreadClock::now() - *std::exchange(other_since_, {});
  if (!is_ticking_) return;
  const Time now = Clock::now();
  const double time = std::min(used.count(), Seconds(most_cost).count());
  const double cost = members_.is_ready()
                          ? std::max(time, Seconds(least_cost).count())
                          : std::max(part_of_idle_time * time, Seconds(least_idle_cost).count());
  const double left = others_time_.refill(share_, now) - cost;
  others_time_.charge(cost);
  if (left > 0) return;
  const Seconds rest((Seconds(least_share).count() - left) / share_.per_second);
  others_wait_until_ = now + std::chrono::ceil<Time::duration>(rest);
}

bool Socket::receive(Received& received) {
  for (int look = 0; look < looks_at_once; ++look) {
    peers_.remove_ended();  // which takes time, too
    handled();
    Group* const group = next_group();
    if (group == nullptr) return false;
    if (group == &others_) other_since_ = ThreadClock::now();
    if (look_at(*group, received)) return true;
  }
  return false;
}

/// Group to serve next; null if there is nothing to do.
Socket::Group* Socket::next_group() {
  const bool has_members = members_.is_ready();
  if (has_members && ++members_in_a_row_ < members_at_once) return &members_;
  members_in_a_row_ = 0;
  if (may_serve_others() && others_.is_ready()) return &others_;
  return has_members ? &members_ : nullptr;
}

/// Reads from one connection, or takes the next few frames of one. True if they were a message.
bool Socket::look_at(Group& group, Received& received) {
  if (group.until_look == 0) {
    const auto ready = group.list.next();
    if (ready) read_from(*ready);
    group.until_look = group.list.has_more() ? 0 : group.turns.size();
    if (ready) return false;
  }
  if (group.until_look > 0) --group.until_look;
  return take_message(group, received);
}

/// The next message of the connection whose turn it is, or some of its other frames. It gets
/// another turn after all others, so that one that sends much does not keep them waiting.
bool Socket::take_message(Group& group, Received& received) {
  if (group.turns.empty()) return false;
  PeerSocket* peer = peers_.find(group.turns.front());
  group.turns.pop_front();
  if (peer == nullptr) return false;
  const std::size_t longest = peer->is_trusted() ? longest_ : peer->longest();
  bool has_message = false;
  peers_.act(*peer, [&](PeerSocket& from) { has_message = from.next(longest, received); });
  peer->has_turn = false;
  if (peer->has_more && !peer->is_over()) group.give_turn(*peer);
  return has_message;
}

void Socket::Group::give_turn(PeerSocket& peer) {
  turns.push_back(peer.name());
  peer.has_turn = true;
}

/// A connection that is ready gets a turn, unless it ended within its handshake. What it sends
/// waits in the system until it has had all messages that are here already.
void Socket::read_from(const ReadyList::Ready& ready) {
  if (ready.id < PeerTable::first_id) return accept(entrances_[ready.id]);
  PeerSocket* peer = peers_.find(ready.id);
  if (peer == nullptr) return;
  peers_.act(*peer, [&](PeerSocket& from) {
    // A step of a handshake that no answer can reach would cost the time of those who wait.
    if (ready.has_ended && !from.is_open()) return from.give_up();
    if (ready.can_write) from.flush();
    if (ready.can_read && !from.is_over() && !from.has_turn) from.read();
  });
  if (!peer->is_over() && !peer->has_turn) group_of(*peer).give_turn(*peer);
}

/// Accepts one connection. Those without session take no places of those over the private entrance.
void Socket::accept(Entrance& entrance) {
  const Time now = Clock::now();
  const bool are_many =
      entrance.trust == Trust::none && peers_.without_session() >= most_without_session_;
  const bool is_full = are_many || peers_.size() >= most_peers_;
  if (is_full && !peers_.make_place(now)) return entrance.set_accepting(peers_.others(), false);
  peers_.remove_ended();
  posix::Descriptor client = entrance.listener.accept();
  if (client.is_open()) {
    const bool has_keys = keys_ && entrance.trust == Trust::none;
    return peers_.add(std::move(client), has_keys ? &*keys_ : nullptr, entrance.trust, now);
  }
  const bool lacks_descriptors = errno == EMFILE || errno == ENFILE;
  if (lacks_descriptors && !peers_.make_place(now)) entrance.set_accepting(peers_.others(), false);
}

void Socket::Entrance::set_accepting(ReadyList& list, bool accepts) {
  if (is_accepting == accepts) return;
  is_accepting = accepts;
  list.change(listener.number(), id, {.read = accepts});
}

void Socket::tend() {
  const Time now = Clock::now();
  if (now < next_tending_) return;
  next_tending_ = now + tending;
  peers_.end_old(now);
  peers_.remove_ended();
  peers_.give_back_memory();
  for (Entrance& entrance : entrances_) entrance.set_accepting(peers_.others(), true);
}

Socket::Ready Socket::poll(milliseconds timeout, std::span<const int> descriptors) {
  handled();
  const bool serves_others = may_serve_others();
  const auto has_more = [](const Group& group) {
    return !group.turns.empty() || group.list.has_more();
  };
  const bool has_message = has_more(members_) || (serves_others && has_more(others_));
  if (has_message) {
    timeout = milliseconds{0};  // but the other descriptors are looked at
  } else if (!serves_others) {
    timeout = std::min(timeout, std::chrono::ceil<milliseconds>(others_wait_until_ - Clock::now()));
    timeout = std::max(timeout, milliseconds{0});
  }
  const bool is_closed = std::ranges::any_of(
      entrances_, [](const Entrance& entrance) { return !entrance.is_accepting; });
  if (is_closed) {  // until tend() no other event may come
    const auto rest = std::chrono::ceil<milliseconds>(next_tending_ - Clock::now());
    timeout = std::clamp(rest, milliseconds{0}, std::max(timeout, milliseconds{0}));
  }
  polled_.assign({{members_.list.number(), POLLIN, 0},
                  {serves_others ? others_.list.number() : -1, POLLIN, 0}});
  const std::size_t ours = polled_.size();
  for (const int descriptor : descriptors) polled_.push_back({descriptor, POLLIN, 0});
  const auto longest = milliseconds(std::numeric_limits<int>::max());
  const int count =
      ::poll(polled_.data(), polled_.size(), static_cast<int>(std::min(timeout, longest).count()));
  if (count < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "poll");
  if (count < 0) return Ready::woken;
  for (std::size_t i = ours; i < polled_.size(); ++i) {
    if (polled_[i].revents != 0) return Ready::woken;
  }
  return has_message || count > 0 ? Ready::message : Ready::timed_out;
}

}  // namespace ziggurat::network
