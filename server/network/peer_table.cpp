// SPDX-License-Identifier: MIT
#include "network/peer_table.h"

#include <malloc.h>

#include <cstring>
#include <utility>

namespace ziggurat::network {
namespace {

/// Names are numbers, 8 bytes each.
std::string name_of(std::uint64_t id) { return {reinterpret_cast<const char*>(&id), sizeof id}; }
std::uint64_t id_of(const std::string& name) {
  std::uint64_t id = 0;
  if (name.size() == sizeof id) std::memcpy(&id, name.data(), sizeof id);
  return id;
}

}  // namespace

PeerTable::PeerTable(const Shared& most) : most_(most) {}

void PeerTable::add(posix::Descriptor descriptor, const zmtp::CurveKeys* keys, Trust trust,
                    Time now) {
  const std::uint64_t id = ++last_id_;
  auto& peer = peers_[id];
  peer = std::make_unique<PeerSocket>(name_of(id), std::move(descriptor), keys, trust, now);
  ++without_session_;
  others_.add(peer->number(), id, {.write = !peer->output().is_empty()});
  settle(*peer, {0, 0, !peer->output().is_empty()});
}

PeerSocket* PeerTable::find(std::uint64_t id) const {
  const auto found = peers_.find(id);
  return found == peers_.end() || found->second->is_over() ? nullptr : found->second.get();
}

PeerSocket* PeerTable::find(const std::string& name) const { return find(id_of(name)); }

PeerTable::Account PeerTable::account_of(const PeerSocket& peer) {
  return {peer.unfinished_bytes(), peer.output().waiting_bytes(), !peer.output().is_empty()};
}

void PeerTable::settle(PeerSocket& peer, const Account& before) {
  const Account after = account_of(peer);
  unfinished_ += after.unfinished - before.unfinished;
  waiting_ += after.waiting - before.waiting;
  if (peer.is_over()) {
    return end(peer, peer.output().is_congested()
                         ? "A client was disconnected because it does not read what it is sent."
                         : peer.fault());
  }
  if (after.has_waiting != before.has_waiting) {
    list_of(peer).change(peer.number(), id_of(peer.name()), {.write = after.has_waiting});
  }
  if (unfinished_ > most_.unfinished && after.unfinished > mebibyte) {
    end(peer, "A client was disconnected: too much of clients' messages has arrived in part.");
  }
  while (waiting_ > most_.waiting) {
    PeerSocket* most = most_waiting_peer();
    if (most == nullptr) break;
    end(*most, "A client was disconnected because too much waits for clients that do not read.");
  }
}

PeerSocket* PeerTable::most_waiting_peer() const {
  PeerSocket* most = nullptr;
  for (const auto& [id, peer] : peers_) {
    if (peer->is_over() || peer->output().waiting_bytes() == 0) continue;
    if (most == nullptr || peer->output().waiting_bytes() > most->output().waiting_bytes())
      most = peer.get();
  }
  return most;
}

ReadyList& PeerTable::list_of(const PeerSocket& peer) {
  return is_other(peer.standing()) ? others_ : members_;
}

void PeerTable::set_standing(const std::string& name, Standing standing, std::size_t longest,
                             Time now) {
  PeerSocket* peer = find(name);
  if (peer == nullptr) return;
  without_session_ -= peer->standing() == Standing::none ? 1 : 0;
  without_session_ += standing == Standing::none ? 1 : 0;
  ReadyList& before = list_of(*peer);
  peer->set_standing(standing, longest, now);
  ReadyList& after = list_of(*peer);
  if (&before == &after) return;
  before.remove(peer->number());
  after.add(peer->number(), id_of(name), {.write = !peer->output().is_empty()});
}

/// The connection is over. What waits for it goes at once, because many can end before the next
/// remove_ended(); what it has sent stays until then.
/// @param why  a sentence for people, if there is something to tell
void PeerTable::end(PeerSocket& peer, std::string why) {
  waiting_ -= peer.output().waiting_bytes();
  has_let_go_ |= peer.unfinished_bytes() + peer.output().waiting_bytes() > mebibyte;
  peer.give_up();
  unfinished_ -= peer.unfinished_bytes();
  list_of(peer).remove(peer.number());
  over_.push_back(id_of(peer.name()));
  if (!why.empty()) notices_.add(std::move(why), std::chrono::steady_clock::now());
}

void PeerTable::remove_ended() {
  for (const std::uint64_t id : over_) {
    const auto found = peers_.find(id);
    if (found == peers_.end()) continue;
    without_session_ -= found->second->standing() == Standing::none ? 1 : 0;
    gone_.push_back(found->second->name());
    peers_.erase(found);
  }
  over_.clear();
}

void PeerTable::give_back_memory() {
  if (std::exchange(has_let_go_, false)) ::malloc_trim(0);
}

std::vector<std::string> PeerTable::take_gone() {
  return gone_.empty() ? std::vector<std::string>() : std::exchange(gone_, {});
}

bool PeerTable::make_place(Time now) {
  PeerSocket* oldest = nullptr;
  for (const auto& [id, peer] : peers_) {
    if (peer->standing() != Standing::none || peer->is_over() || peer->is_trusted()) continue;
    const auto order = [](const PeerSocket& one) { return std::pair(one.is_open(), one.since()); };
    if (oldest == nullptr || order(*peer) < order(*oldest)) oldest = peer.get();
  }
  if (oldest == nullptr || oldest->since() + least_age > now) return false;
  end(*oldest, "Too many connections without session: the oldest are disconnected.");
  return true;
}

void PeerTable::end_old(Time now) {
  for (const auto& [id, peer] : peers_) {
    if (peer->standing() != Standing::none || peer->is_over() || peer->is_trusted()) continue;
    const Time::duration age = now - peer->since();
    if (age > time_without_session || (!peer->is_open() && age > handshake_time)) end(*peer);
  }
}

std::vector<int> PeerTable::flush() {
  std::vector<int> waiting;
  for (const auto& [id, peer] : peers_) {
    if (peer->is_over()) continue;
    peer->flush();
    if (!peer->output().is_empty() && !peer->is_over()) waiting.push_back(peer->number());
  }
  return waiting;
}

std::vector<std::string> PeerTable::take_notices(Time now) {
  notices_.tell_last(now);
  return notices_.take();
}

}  // namespace ziggurat::network
