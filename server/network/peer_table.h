// SPDX-License-Identifier: MIT
#pragma once
// All connections, and what they take together.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "network/limits.h"
#include "network/link.h"
#include "network/notices.h"
#include "network/peer_socket.h"
#include "network/ready_list.h"

namespace ziggurat::network {

class PeerTable {
 public:
  static constexpr std::uint64_t first_id = 1024;  ///< numbers below are free for other descriptors

  explicit PeerTable(const Shared& most = {});

  /// A client has connected.
  void add(posix::Descriptor descriptor, const zmtp::CurveKeys* keys, Trust trust, Time now);
  /// Null if its connection is over. Pointers hold until remove_ended().
  PeerSocket* find(std::uint64_t id) const;
  PeerSocket* find(const std::string& name) const;

  /// Does something with a connection, and keeps account of what that changes.
  template <class Action>
  void act(PeerSocket& peer, Action action) {
    const Account before = account_of(peer);
    action(peer);
    settle(peer, before);
  }
  void set_standing(const std::string& name, Standing standing, std::size_t longest, Time now);

  /// Forgets connections that are over.
  void remove_ended();
  /// Returns the memory of forgotten connections to the system.
  void give_back_memory();
  /// Names of connections that were forgotten since the last call.
  std::vector<std::string> take_gone();

  /// Disconnects the oldest connection without session, first of those whose handshake is not over.
  /// False if all are young.
  bool make_place(Time now);
  /// Disconnects those that have been without session for too long.
  void end_old(Time now);
  /// Sends what waits, as far as possible. @returns descriptors of those who do not read yet
  std::vector<int> flush();

  std::size_t size() const { return peers_.size(); }
  std::size_t without_session() const { return without_session_; }  ///< connections without session
  ReadyList& members() { return members_; }
  ReadyList& others() { return others_; }  ///< see is_other()
  std::vector<std::string> take_notices(Time now);

 private:
  struct Account {
    std::size_t unfinished = 0, waiting = 0;  // bytes
    bool has_waiting = false;
  };
  static Account account_of(const PeerSocket& peer);
  void settle(PeerSocket& peer, const Account& before);
  ReadyList& list_of(const PeerSocket& peer);
  void end(PeerSocket& peer, std::string why = {});
  PeerSocket* most_waiting_peer() const;

  const Shared most_;
  ReadyList members_, others_;
  std::unordered_map<std::uint64_t, std::unique_ptr<PeerSocket>> peers_;
  std::uint64_t last_id_ = first_id;
  std::vector<std::uint64_t> over_;  // not forgotten yet
  std::vector<std::string> gone_;
  std::size_t without_session_ = 0, unfinished_ = 0, waiting_ = 0;
  bool has_let_go_ = false;  // much memory, since give_back_memory()
  Notices notices_;
};

}  // namespace ziggurat::network
