// SPDX-License-Identifier: MIT
#pragma once
// Ticks on their way from the run's thread to the server's thread, which encodes them. The run's
// thread only copies; the newest tick wins.

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <variant>
#include <vector>

#include "channels/channels.h"
#include "channels/copies.h"
#include "view/hub.h"

namespace ziggurat::view {

/// Channels that a tick is encoded for: ids, ascending.
struct Wanted {
  std::vector<std::uint32_t> tick;                      ///< for messages of each tick
  std::vector<std::uint32_t> latched;                   ///< for latched messages and commands
  channels::Sensed sensed = channels::Sensed::nothing;  ///< that they show
};

class Feed {
 public:
  static constexpr std::size_t most_ticks = 2;      ///< that wait, with their answers
  static constexpr std::size_t most_events = 1000;  ///< that wait; later ones are lost

  // On the run's thread. None of them waits until something is encoded.

  /// The world began, or entities came or went. Ticks of before that still wait are not shown:
  /// show() follows, with all that is wanted.
  void populate(const channels::Population& population);
  void set_layers(const channels::Layers& layers);
  /// If too many wait, the oldest is dropped; what must arrive of it goes to the next.
  void show(const channels::Moment& moment, Wanted wanted);
  /// The tick was answered. @param wanted  ids of channels, ascending
  void show_commands(const channels::Moment& moment, std::vector<std::uint32_t> wanted);
  void show_event(channels::Message message);

  // On the server's thread.

  /// Encodes what waits, and passes it on.
  void pass_on(Hub& hub);

 private:
  struct Tick {
    std::unique_ptr<channels::TickCopy> world;
    Wanted wanted;
    bool is_answer = false;  ///< its time and commands only
  };
  using Item = std::variant<Tick, channels::Message>;

  std::unique_ptr<channels::TickCopy> take_copy();
  void give_back(Tick& tick);
  void drop_oldest();
  void encode(const Tick& tick, std::vector<channels::Message>& to);

  std::mutex mutex_;  // of all up to the next remark
  std::deque<Item> waiting_;
  std::size_t ticks_ = 0, events_ = 0;                               // that wait; without answers
  std::shared_ptr<const channels::PopulationCopy> next_population_;  // null: none waits
  std::optional<channels::Layers> next_layers_;
  std::vector<std::unique_ptr<channels::TickCopy>> free_;  // whose memory is used again

  // Members of the server's thread:
  std::shared_ptr<const channels::PopulationCopy> population_;  // that channels_ refers to
  channels::Channels channels_;
  std::vector<channels::Message> messages_;  // of one tick; keeps its memory
};

}  // namespace ziggurat::view
