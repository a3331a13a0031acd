// SPDX-License-Identifier: MIT
#pragma once
// Sources of requests: sessions of the network, and others that this process serves itself, as the
// viewers of a live server.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "network/server.h"
#include "supervision/world_change.h"

namespace ziggurat::supervision {

/// Requests that do not come over the network. Their calls are marked as local.
struct LocalCalls {
  std::function<std::vector<network::Call>()> take;
  std::function<bool(const network::Call&)> can_hear;
  std::function<void(const network::Call&, std::uint64_t tick)> done;
  std::function<void(const network::Call&, const std::string& why)> refused;
};

class Callers {
 public:
  /// @param server  must outlive this
  explicit Callers(network::Server& server) : server_(server) {}

  void add(LocalCalls local) { local_ = std::move(local); }

  /// While that holds requests wait.
  void hold(bool is_held) { is_held_ = is_held; }
  /// Requests that arrived since the last call.
  std::vector<network::Call> take();
  bool can_hear(const network::Call& call) const;
  /// Every call is answered once: it was done at a tick, or it was refused.
  void done(const network::Call& call, std::uint64_t tick);
  void refused(const network::Call& call, const wire::Fault& fault);

  /// From now on each act is told when it is done, in order.
  void on_world_change(TellWorldChange tell) { tell_world_change_ = std::move(tell); }
  void tell(const WorldChange& change) const {
    if (tell_world_change_) tell_world_change_(change);
  }

  /// The world was changed beside a tick by another than a caller.
  void note_change() { ++changes_; }
  /// Number of changes of the world beside a tick: by moves, spawns, removals.
  std::uint64_t changes() const { return changes_; }

 private:
  network::Server& server_;
  LocalCalls local_;
  TellWorldChange tell_world_change_;
  std::uint64_t changes_ = 0;
  bool is_held_ = false;
};

enum class Reply { given, later };

/// Answers the calls that wait, in order of arrival, and removes those that have an answer, or that
/// no session waits for any more. Requests of one connection are answered in their order; different
/// connections do not wait for each other.
void answer_waiting(std::vector<network::Call>& waiting, const Callers& callers,
                    const std::function<Reply(const network::Call&)>& answer);

}  // namespace ziggurat::supervision
