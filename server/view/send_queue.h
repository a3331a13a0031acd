// SPDX-License-Identifier: MIT
#pragma once
// Output that waits for a viewer, of bounded size. Answers are kept, or the viewer is disconnected.
// The oldest ticks are dropped whole, except for items that must not be lost.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "channels/message.h"

namespace ziggurat::view {

/// Rule for an item when its tick is dropped.
enum class Keep {
  nothing,  ///< the next tick replaces it
  newest,   ///< the newest one of its channel is sent
  all,      ///< each is sent, as long as they are few
};

/// A WebSocket message: `head`, then the content.
struct Item {
  bool is_text = false;
  Keep keep = Keep::nothing;
  std::uint32_t channel = 0;  ///< 0: of none
  std::string head;
  std::shared_ptr<const channels::Content> content;  ///< may be null

  std::size_t size() const { return head.size() + (content ? content->held() : 0); }
};

class SendQueue {
 public:
  static constexpr std::size_t most_answers = std::size_t{1} << 20;  ///< [bytes]
  static constexpr std::size_t most_frames = std::size_t{1} << 20;   ///< [bytes]
  static constexpr std::size_t most_waiting =
      4;  ///< frames: a tick is two, before its answers and after
  static constexpr std::size_t most_kept = std::size_t{256} << 10;  ///< of Keep::all [bytes]

  /// False: too much waits; the viewer is to be disconnected.
  bool add_answer(Item item);
  /// The messages of a tick. If too much waits, earlier ticks are dropped that were not begun.
  void add_frame(std::vector<Item> items);
  /// Adds items without a tick of their own, as events and answers to subscriptions. They wait with
  /// the newest tick, so that they never drop one, and replace older ones of Keep::newest.
  void add_to_newest(std::vector<Item> items);

  /// Drops the waiting items of these channels.
  /// @param channels  ascending
  void forget(std::span<const std::uint32_t> channels);

  /// The next message to be sent: answers first, then ticks in their order.
  std::optional<Item> next();
  /// More waits than any viewer that reads leaves: it is to be disconnected.
  bool is_too_much() const { return size() > std::size_t{64} << 20; }
  bool has_answer() const { return !answers_.empty(); }
  bool empty() const { return answers_.empty() && frames_.empty(); }
  std::size_t size() const { return answer_bytes_ + frame_bytes_; }  ///< [bytes]
  std::uint64_t dropped() const { return dropped_; }                 ///< ticks

 private:
  struct Frame {
    std::deque<Item> items;
    std::size_t bytes = 0;
    std::size_t kept = 0;  // [bytes] of Keep::all
    bool is_begun = false;
  };
  void drop(std::size_t frame);
  void add(Frame& frame, Item item);
  bool take_out(Frame& frame, const Item& item);

  std::deque<Item> answers_;
  std::deque<Frame> frames_;  // none is empty
  std::size_t answer_bytes_ = 0, frame_bytes_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace ziggurat::view
