// SPDX-License-Identifier: MIT
#include "layout.h"
#include "text/printable.h"

namespace ziggurat {

void Layout::add_tags() {
  using Payloads = Settings<std::string, google::protobuf::RepeatedPtrField<std::string>>;
  auto& payloads = add(Payloads(&v1::Command::mutable_tag_payloads));
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    for (const v1::TagDescription& from : robot.tags()) {
      Tag& tag = to.tags_.emplace_back();
      tag.id_ = from.id();
      tag.payload_ = &payloads.add(from.payload());
      tag.changed_ = &payloads.changed();
    }
  });
}

void Tag::set_payload(std::string_view payload) {
  if (payload.size() > max_payload_bytes) {
    throw std::length_error("the payload of tag '" + text::printable_part(id_) + "' has " +
                            std::to_string(payload.size()) + " bytes; at most " +
                            std::to_string(max_payload_bytes) + " are allowed");
  }
  payload_->assign(payload);
  *changed_ = true;
}

}  // namespace ziggurat
