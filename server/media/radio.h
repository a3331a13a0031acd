// SPDX-License-Identifier: MIT
#pragma once
// Radios: a message reaches every other radio of the medium that is strictly closer than the
// sender's range, through everything. A radio that sends in a tick receives nothing in it.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "media/devices_index.h"
#include "world/layout.h"
#include "world/limits.h"
#include "world/radio_messages.h"
#include "world/state.h"

namespace ziggurat::media {

/// From a radio that sent to one that received.
struct RadioLink {
  std::size_t sender = 0, receiver = 0;  ///< into Layout::radios
};

class RadioMedium {
 public:
  /// @param most  messages that all receive together at a tick. Of more, each sender's last ones
  /// are left out, and as
  ///              many of one are kept as of another: one that sends very many takes nothing from
  ///              the others
  explicit RadioMedium(std::size_t most = world::most_received_messages) : most_(most) {}

  /// Delivers the messages of a tick. All are known before the first is delivered. So the result
  /// depends neither on the order of `sent` (between radios) nor on that of robots.
  /// @param index     of the poses that the messages leave at
  /// @param sent      emptied
  /// @param received  replaced: ascending by receiver, then sender, then as sent
  void deliver(const world::Layout& layout, const DevicesIndex& index, world::RadioMessages& sent,
               world::RadioMessages& received);

  /// Links of the last delivery, one per pair, ascending by sender, then receiver.
  const std::vector<RadioLink>& links() const { return links_; }

 private:
  void sort(const world::RadioMessages& sent, std::size_t radios);
  std::size_t find_links(const world::Layout& layout, const DevicesIndex& index);
  bool sends(std::size_t radio) const { return starts_[radio] != starts_[radio + 1]; }

  std::size_t most_;
  std::vector<std::uint32_t> starts_;  // per radio: its first place in order_; one more at the end
  std::vector<std::uint32_t> order_;   // into sent.entries: by radio, then as sent
  std::vector<std::size_t> places_;    // per receiver: where its next message goes
  std::vector<std::size_t> found_;
  std::vector<RadioLink> links_;
};

}  // namespace ziggurat::media
