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

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr milliseconds linger{1000};  // what waits at the end may take this long
constexpr milliseconds tending{500};
constexpr milliseconds saved_share{5};  // of the time for others
constexpr int accepted_at_once = 16;
constexpr int looks_at_once = 64;  // at connections that may send without end and no message

/// How many descriptors connections may have: an eighth is for files and processes.
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
      share_(config.curve ? share_of_others_with_keys : share_of_others, saved_share) {
  if (config.curve) keys_.emplace(*config.curve);
  const bool allows_any = config.insecure || config.curve;
  for (const std::string& endpoint : config.endpoints) listen(endpoint, false, allows_any);
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
  listen(config.private_endpoint, true, false);
  std::rotate(endpoints_.begin(), endpoints_.end() - 1, endpoints_.end());
}

void Socket::listen(const std::string& endpoint, bool is_private, bool allows_any) {
  check_endpoint(endpoint, allows_any);
  const std::uint64_t id = entrances_.size();
  const Entrance& entrance = entrances_.emplace_back(Entrance{Listener(endpoint), id, is_private});
  endpoints_.push_back(entrance.listener.endpoint());
  peers_.others().add(entrance.listener.number(), id);
}

/// @param write  writes the content, `size` bytes
Delivery Socket::send(const std::string& connection, std::size_t size, bool is_observation,
                      const auto& write) {
  PeerSocket* peer = peers_.find(connection);
  if (peer == nullptr || !peer->is_open()) return Delivery::unreachable;
  const std::size_t at = peer->content_at(size);
  frame_.reserve(at + size);
  write(frame_.bytes.get() + at);
  peers_.act(*peer, [&](PeerSocket& to) { to.send(frame_, size, is_observation); });
  return peer->is_over() ? Delivery::unreachable : Delivery::sent;
}

Delivery Socket::send(const std::string& connection, const wire::Outbox& message) {
  return send(connection, message.size(), message.is_observation(),
              [&](std::uint8_t* to) { message.write(to); });
}

Delivery Socket::send(const std::string& connection, std::string_view bytes, bool is_observation) {
  return send(connection, bytes.size(), is_observation,
              [&](std::uint8_t* to) { std::memcpy(to, bytes.data(), bytes.size()); });
}

void Socket::set_standing(const std::string& connection, Standing standing,
                          std::size_t longest) {
  peers_.set_standing(connection, standing, longest, Clock::now());
  PeerSocket* peer = peers_.find(connection);
  if (peer == nullptr || !peer->has_turn) return;
  for (Group* group : {&controllers_, &others_}) std::erase(group->turns, connection);
  group_of(*peer).give_turn(*peer);
}

Socket::Group& Socket::group_of(const PeerSocket& peer) {
  return peer.standing() == Standing::controller ? controllers_ : others_;
}

bool Socket::may_serve_others() { return !is_ticking_ || share_.has_some(Clock::now()); }

void Socket::begin_charge() {
  if (!charged_since_) charged_since_ = ThreadClock::now();
}

void Socket::handled() {
  if (!charged_since_) return;
  const TimeShare::Seconds used = ThreadClock::now() - *charged_since_;
  if (is_ticking_) share_.charge(std::max<TimeShare::Seconds>(used, least_cost));
  charged_since_.reset();
}

bool Socket::receive(Received& received) {
  peers_.remove_ended();
  const bool has_one = receive_from(controllers_, received);
  handled();  // the look at controllers was between two messages of others
  if (has_one) return true;
  if (!may_serve_others() || others_.is_idle()) return false;
  begin_charge();
  if (receive_from(others_, received)) return true;
  peers_.remove_ended();  // to close them takes time, too
  handled();
  return false;
}

bool Socket::receive_from(Group& group, Received& received) {
  for (int look = 0; look < looks_at_once; ++look) {
    if (group.until_look > 0) {
      --group.until_look;
    } else if (const auto ready = group.list.next()) {
      read_from(*ready);
      if (group.list.has_more()) continue;
      group.until_look = group.turns.size();
    } else {
      if (group.turns.empty()) return false;
      group.until_look = group.turns.size();
    }
    if (take_message(group, received)) return true;
  }
  return false;
}

/// The next message of the connection whose turn it is. It gets another turn after all others, so
/// that one that sends much does not keep them waiting.
bool Socket::take_message(Group& group, Received& received) {
  if (group.turns.empty()) return false;
  PeerSocket* peer = peers_.find(group.turns.front());
  group.turns.pop_front();
  if (peer == nullptr) return false;
  const std::size_t longest = peer->is_trusted() ? longest_ : peer->longest();
  bool has_message = false;
  peers_.act(*peer, [&](PeerSocket& from) { has_message = from.next(longest, received); });
  peer->has_turn = false;
  if (has_message) group.give_turn(*peer);
  return has_message;
}

void Socket::Group::give_turn(PeerSocket& peer) {
  turns.push_back(peer.name());
  peer.has_turn = true;
}

/// A connection that is ready gets a turn, unless it ended within its handshake. What it sends waits in the system until it has had all
/// messages that are here already.
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

/// Connections without session take no places of those over the private entrance.
void Socket::accept(Entrance& entrance) {
  for (int i = 0; i < accepted_at_once; ++i) {
    const Time now = Clock::now();
    const bool are_many =
        !entrance.is_private && peers_.without_session() >= most_without_session_;
    const bool is_full = are_many || peers_.size() >= most_peers_;
    if (is_full && !peers_.make_place(now)) return entrance.set_accepting(peers_.others(), false);
    peers_.remove_ended();
    posix::Descriptor client = entrance.listener.accept();
    if (!client.is_open()) {
      const bool lacks_descriptors = errno == EMFILE || errno == ENFILE;
      if (lacks_descriptors && !peers_.make_place(now)) {
        entrance.set_accepting(peers_.others(), false);
      }
      return;
    }
    peers_.add(std::move(client), keys_ && !entrance.is_private ? &*keys_ : nullptr,
               entrance.is_private, now);
  }
}

void Socket::Entrance::set_accepting(ReadyList& list, bool accepts) {
  if (is_accepting == accepts) return;
  is_accepting = accepts;
  list.change(listener.number(), id, accepts, false);
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
  const bool has_message = has_more(controllers_) || (serves_others && has_more(others_));
  if (has_message) {
    timeout = milliseconds{0};  // but the other descriptors are looked at
  } else if (!serves_others) {
    timeout = std::min(timeout, std::chrono::ceil<milliseconds>(share_.time_until_some()));
  }
  const bool is_closed = std::ranges::any_of(
      entrances_, [](const Entrance& entrance) { return !entrance.is_accepting; });
  if (is_closed) {  // until tend() no other event may come
    const auto rest = std::chrono::ceil<milliseconds>(next_tending_ - Clock::now());
    timeout = std::clamp(rest, milliseconds{0}, std::max(timeout, milliseconds{0}));
  }
  polled_.assign({{controllers_.list.number(), POLLIN, 0},
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
