#include "recording/mcap/contents.h"

#include <algorithm>

namespace ziggurat::mcap {

const Channel* Contents::channel_of(std::string_view topic) const {
  for (const auto& [id, channel] : channels) {
    if (channel.topic == topic) return &channel;
  }
  return nullptr;
}

const AttachmentIndex* Contents::attachment_named(std::string_view name) const {
  const auto found = std::find_if(attachments.rbegin(), attachments.rend(),
                                  [&](const auto& each) { return each.name == name; });
  return found == attachments.rend() ? nullptr : &*found;
}

std::uint64_t Contents::messages_of(std::uint16_t channel) const {
  for (const auto& [id, count] : statistics.channel_messages) {
    if (id == channel) return count;
  }
  return 0;
}

}  // namespace ziggurat::mcap
