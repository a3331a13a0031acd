// SPDX-License-Identifier: MIT
#include "media/radio.h"

#include <algorithm>
#include <utility>

namespace ziggurat::media {

void RadioMedium::sort(const world::RadioMessages& sent, std::size_t radios) {
  starts_.assign(radios + 1, 0);
  for (const auto& entry : sent.entries) ++starts_[entry.radio];
  for (std::size_t r = 1; r <= radios; ++r) starts_[r] += starts_[r - 1];
  order_.resize(sent.entries.size());
  for (std::size_t i = sent.entries.size(); i-- > 0;) {
    order_[--starts_[sent.entries[i].radio]] = static_cast<std::uint32_t>(i);
  }
}

/// @returns how many messages would be received over them
std::size_t RadioMedium::find_links(const world::Layout& layout, const DevicesIndex& index) {
  const std::vector<world::RadioLayout>& radios = layout.radios;
  std::size_t wanted = 0;
  for (std::size_t sender = 0; sender < radios.size(); ++sender) {
    if (!sends(sender)) continue;
    const math::Vector3& from = index.position(index.radios, sender);
    index.find(index.radios, from, radios[sender].range, found_);
    for (const std::size_t receiver : found_) {
      if (receiver == sender || !radios[receiver].receives || sends(receiver)) continue;
      if (radios[receiver].medium != radios[sender].medium) continue;
      const double distance = (index.position(index.radios, receiver) - from).norm();
      if (!reaches(radios[sender].range, distance)) continue;
      wanted += starts_[sender + 1] - starts_[sender];
      if (links_.size() < most_) links_.push_back({sender, receiver});
    }
  }
  return wanted;
}

void RadioMedium::deliver(const world::Layout& layout, const DevicesIndex& index,
                          world::RadioMessages& sent, world::RadioMessages& received) {
  received.clear();
  links_.clear();
  if (sent.entries.empty()) return sent.clear();
  sort(sent, layout.radios.size());
  const std::size_t wanted = find_links(layout, index);
  const std::size_t share = wanted > most_ ? most_ / links_.size() : wanted;
  const auto end_of = [&](std::size_t sender) {
    return starts_[sender] + std::min<std::size_t>(starts_[sender + 1] - starts_[sender], share);
  };

  places_.assign(layout.radios.size() + 1, 0);
  for (const RadioLink& link : links_)
    places_[link.receiver] += end_of(link.sender) - starts_[link.sender];
  std::size_t total = 0;
  for (std::size_t& place : places_) total += std::exchange(place, total);
  received.entries.resize(total);
  received.left_out = wanted - total;
  for (const RadioLink& link : links_) {
    for (std::size_t i = starts_[link.sender]; i < end_of(link.sender); ++i) {
      const auto& entry = sent.entries[order_[i]];
      received.entries[places_[link.receiver]++] = {link.receiver, entry.begin, entry.size,
                                                    link.sender};
    }
  }
  std::swap(received.bytes, sent.bytes);  // the receivers share them
  sent.clear();
}

}  // namespace ziggurat::media
