// SPDX-License-Identifier: MIT
#include "view/known_channels.h"

#include <algorithm>
#include <utility>

#include "view/messages.h"

namespace ziggurat::view {

void KnownChannels::change(std::span<const std::uint32_t> gone, bool is_all_old) {
  for (const std::uint32_t channel : gone) {
    if (channel >= told_.size() || !told_[channel]) continue;
    told_[channel] = false;
    gone_.push_back(channel);
  }
  is_all_ &= is_all_old;
}

std::optional<Item> KnownChannels::next(std::span<const channels::Channel> channels) {
  if (!gone_.empty()) return unadvertise(std::exchange(gone_, {}));
  if (is_all_ || channels.empty()) return std::nullopt;
  told_.resize(std::max<std::size_t>(told_.size(), channels.back().id + 1));
  std::vector<const channels::Channel*> list;
  std::size_t bytes = 0;
  is_all_ = true;
  for (const channels::Channel& each : channels) {
    if (told_[each.id]) continue;
    bytes += each.topic.size() + each.schema->descriptors.size() / 3 * 4;
    is_all_ = list.empty() || bytes <= longest_list;
    if (!is_all_) break;
    told_[each.id] = true;
    list.push_back(&each);
  }
  if (list.empty()) return std::nullopt;
  return advertise(list);
}

}  // namespace ziggurat::view
