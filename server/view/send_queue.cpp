// SPDX-License-Identifier: MIT
#include "view/send_queue.h"

#include <algorithm>
#include <utility>

namespace ziggurat::view {

bool SendQueue::add_answer(Item item) {
  answer_bytes_ += item.size();
  answers_.push_back(std::move(item));
  return answer_bytes_ <= most_answers;
}

void SendQueue::add_frame(std::vector<Item> items) {
  if (items.empty()) return;
  frames_.emplace_back();
  for (Item& item : items) add(frames_.back(), std::move(item));
  for (;;) {
    const std::size_t oldest = frames_.front().is_begun ? 1 : 0;
    const bool is_much = frame_bytes_ > most_frames || frames_.size() - oldest > most_waiting;
    if (!is_much || oldest + 1 >= frames_.size()) return;  // the newest stays
    drop(oldest);
  }
}

void SendQueue::add(Frame& frame, Item item) {
  frame.bytes += item.size();
  frame_bytes_ += item.size();
  if (item.keep == Keep::all) frame.kept += item.size();
  frame.items.push_back(std::move(item));
}

/// Counts an item no longer; it is then erased. @return true
bool SendQueue::take_out(Frame& frame, const Item& item) {
  frame.bytes -= item.size();
  frame_bytes_ -= item.size();
  if (item.keep == Keep::all) frame.kept -= item.size();
  return true;
}

void SendQueue::add_to_newest(std::vector<Item> items) {
  if (frames_.empty()) return add_frame(std::move(items));
  Frame& frame = frames_.back();
  for (Item& item : items) {
    if (item.keep == Keep::newest) {
      std::erase_if(frame.items, [&](const Item& older) {
        return older.keep == Keep::newest && older.channel == item.channel &&
               take_out(frame, older);
      });
    }
    add(frame, std::move(item));
  }
  if (frame.kept <= most_kept) return;
  std::erase_if(frame.items, [&](const Item& oldest) {
    return oldest.keep == Keep::all && frame.kept > most_kept && take_out(frame, oldest);
  });
}

/// Drops a tick; items that must be kept move to the tick behind.
void SendQueue::drop(std::size_t place) {
  Frame dropped = std::move(frames_[place]);
  frames_.erase(frames_.begin() + static_cast<std::ptrdiff_t>(place));
  frame_bytes_ -= dropped.bytes;
  ++dropped_;
  Frame& heir = frames_[place];
  std::size_t kept = 0;
  for (auto item = dropped.items.rbegin(); item != dropped.items.rend(); ++item) {
    if (item->keep == Keep::nothing) continue;
    const bool is_old = std::ranges::any_of(heir.items, [&](const Item& newer) {
      return item->keep == Keep::newest && newer.keep == Keep::newest &&
             newer.channel == item->channel;
    });
    if (is_old) continue;
    if (item->keep == Keep::all && (kept += item->size()) > most_kept) continue;
    heir.bytes += item->size();
    if (item->keep == Keep::all) heir.kept += item->size();
    frame_bytes_ += item->size();
    heir.items.push_front(std::move(*item));
  }
}

void SendQueue::forget(std::span<const std::uint32_t> channels) {
  for (Frame& frame : frames_) {
    std::erase_if(frame.items, [&](const Item& item) {
      return std::ranges::binary_search(channels, item.channel) && take_out(frame, item);
    });
  }
  std::erase_if(frames_, [](const Frame& frame) { return frame.items.empty(); });
}

std::optional<Item> SendQueue::next() {
  if (!answers_.empty()) {
    Item item = std::move(answers_.front());
    answers_.pop_front();
    answer_bytes_ -= item.size();
    return item;
  }
  if (frames_.empty()) return std::nullopt;
  Frame& frame = frames_.front();
  Item item = std::move(frame.items.front());
  frame.items.pop_front();
  frame.is_begun = true;
  take_out(frame, item);
  if (frame.items.empty()) frames_.pop_front();
  return item;
}

}  // namespace ziggurat::view
