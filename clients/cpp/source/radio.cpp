#include "ziggurat/radio.h"

#include <algorithm>
#include <stdexcept>

#include "radio_traffic.h"

namespace ziggurat {
namespace {

constexpr std::size_t overhead = 16;  // bytes around a message's payload, at most

void check(std::size_t value, std::size_t most, const std::string& what) {
  if (value <= most) return;
  throw std::length_error(what + " " + std::to_string(value) + " at this tick; " +
                          std::to_string(most) + " are the most");
}

}  // namespace

void Radio::send(Bytes message) {
  if (traffic_ == nullptr) {
    throw std::logic_error("radio '" + id_ + "' does not send: the controller's <actuators> have " +
                           "no radios");
  }
  Traffic::Total total = traffic_->robots[robot_];
  total.messages += 1;
  total.bytes += message.size();
  const std::size_t bytes = traffic_->bytes + message.size() + overhead;
  check(message.size(), max_message_bytes, "the bytes of a message of radio '" + id_ + "' are");
  check(total.bytes, max_bytes_per_robot,
        "the bytes that the robot of radio '" + id_ + "' sends are");
  check(total.messages, max_messages_per_robot,
        "the messages that the robot of radio '" + id_ + "' sends are");
  check(bytes, traffic_->max_bytes, "the bytes that this session sends by radio are");
  v1::RadioMessage& to = *traffic_->messages.Add();
  to.set_radio(index_);
  to.mutable_payload()->assign(reinterpret_cast<const char*>(message.data()), message.size());
  traffic_->robots[robot_] = total;
  traffic_->bytes = bytes;
}

void Radio::Traffic::clear() {
  constexpr std::size_t enough = std::size_t{64} << 20;
  messages.Clear();
  std::fill(robots.begin(), robots.end(), Total{});
  cleared_ += bytes;
  bytes = 0;
  if (cleared_ < enough) return;
  google::protobuf::RepeatedPtrField<v1::RadioMessage>().Swap(&messages);
  cleared_ = 0;
}

}  // namespace ziggurat
