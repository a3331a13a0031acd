// SPDX-License-Identifier: MIT
#pragma once
// A link that delays and loses messages between the barrier and its peers on purpose. It sits
// between the two, which know nothing of it, and learns what it needs from the messages that pass:
// a Welcome says whose they are.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "network/delays.h"
#include "network/link.h"
#include "wire/inbox.h"
#include "wire/outbox.h"

namespace ziggurat::v1 {
class Welcome;
}

namespace ziggurat::network {

class DisturbedLink {
 public:
  /// The link behind: sends bytes over a connection. Of Observations that wait there the newest
  /// wins.
  using SendBytes = std::function<Delivery(const std::string& connection, std::string_view bytes,
                                           MessageKind kind)>;

  struct Target {
    std::string id;  ///< in the scene: of a controller or director
    Injection injection = {};
    bool is_director = false;
  };
  /// @param targets     all controllers of the scene, then its directors
  /// @param most_bytes  that are held back of one client's messages; more arrive early
  DisturbedLink(std::vector<Target> targets, std::uint64_t seed, std::size_t most_bytes,
                SendBytes send);

  /// Draws from this seed from now on.
  void set_seed(std::uint64_t seed) { seed_ = seed; }

  /// Sends a message, now or later or not at all.
  Delivery send(const std::string& connection, const wire::Outbox& message, Time now);
  /// Whether a message that has come over the socket arrives now; else it is lost, or next() has
  /// it when its time has come.
  bool arrives(const Received& received, Time now);
  /// A message that was held back and arrives now, if there is any. Valid until the next call.
  std::optional<Received> next(Time now);
  /// Sends what was held back long enough.
  void release(Time now);
  /// When next() or release() have something to do.
  Time next_event() const;

  /// Whether a session over this connection is disturbed, or was and something is under way still.
  bool holds(const std::string& connection) const { return lines_.contains(connection); }
  /// Per target.
  const std::vector<Lost>& lost_messages() const { return lost_; }
  /// Sentences for people since the last call.
  std::vector<std::string> take_notices();

 private:
  struct Held {
    std::string connection;
    std::string bytes;
    bool is_single_frame = true;
    Access access;
    std::size_t skipped = 0;
  };
  struct Outgoing {
    std::string bytes;
    MessageKind kind = MessageKind::other;
  };
  /// A target that drives robots of a session.
  struct Path {
    std::size_t target = 0;
    std::string name;  ///< of the controller and its first robot here, for draw_effect()
  };
  /// A connection whose session has disturbed controllers.
  struct Line {
    std::vector<Path> paths;  ///< none: its session is over
    bool may_lose = false;    ///< every robot has a deadline
    bool is_broken = false;   ///< a message that was held back could not be sent
    DelayLine<Outgoing> outgoing;
    DelayLine<Held> incoming;
    std::size_t incoming_bytes = 0;
  };

  Line* find(const std::string& connection);
  std::vector<Path> paths_of(const v1::Welcome& welcome) const;
  void begin(const std::string& connection, const v1::Welcome& welcome);
  Effect draw(const Line& line, Direction direction, std::uint64_t tick);
  Delivery pass(const std::string& connection, Line& line, Outgoing message, Time arrival,
                Time now);
  void end(const std::string& connection, Line& line, bool is_orderly, Time now);

  std::vector<Target> targets_;
  std::uint64_t seed_;
  std::size_t most_bytes_;
  SendBytes send_;
  std::map<std::string, Line> lines_;  // by connection
  wire::Inbox inbox_;                  // to see which message passes
  Held arrived_;                       // what next() gave
  std::vector<Lost> lost_;
  std::vector<std::string> notices_;
};

}  // namespace ziggurat::network
