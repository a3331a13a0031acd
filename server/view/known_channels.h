// SPDX-License-Identifier: MIT
#pragma once
// Channels that a viewer knows, and changes that it is still to be sent. Lists are made when they
// can be sent, so that a viewer that does not read holds none.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "channels/channel.h"
#include "view/send_queue.h"

namespace ziggurat::view {

class KnownChannels {
 public:
  static constexpr std::size_t longest_list = std::size_t{512}
                                              << 10;  ///< of topics and schemas [bytes]

  /// @param gone  channels that are there no more
  /// @param is_all_old  no channel is new
  void change(std::span<const std::uint32_t> gone, bool is_all_old);
  /// The next message on channels; none if the viewer knows all.
  /// @param channels  all of now, ascending by id
  std::optional<Item> next(std::span<const channels::Channel> channels);

 private:
  std::vector<bool> told_;           // by channel
  std::vector<std::uint32_t> gone_;  // to be unadvertised
  bool is_all_ = false;              // none is to be advertised
};

}  // namespace ziggurat::view
