// SPDX-License-Identifier: MIT
#include "layout.h"
#include "text/printable.h"

namespace ziggurat {

/// Radio messages that the robots of a session receive and send.
class RadioTraffic final : public Channel {
 public:
  /// @param max_bytes  that the session may send at one tick
  RadioTraffic(std::size_t robots, std::size_t max_bytes)
      : totals_(robots), max_bytes_(max_bytes) {}

  /// The next radio's; null if it does not receive. Returns the radio's index.
  std::uint32_t add(std::vector<Bytes>* received) {
    received_.push_back(received);
    return static_cast<std::uint32_t>(received_.size() - 1);
  }
  /// @throws std::length_error
  void send(const std::string& radio, std::uint32_t index, std::uint32_t robot, Bytes message);

  void check(const v1::Observation& from) const override;
  void read(const v1::Observation& from) override;
  void write(v1::Command& to) override { to.mutable_radio_messages()->Swap(&sent_); }
  void sent() override { reset(); }
  void reset() override;

 private:
  struct Total {
    std::size_t messages = 0;
    std::size_t bytes = 0;
  };
  std::vector<std::vector<Bytes>*> received_;                  // by radio
  google::protobuf::RepeatedPtrField<v1::RadioMessage> sent_;  // long-lived: keeps its memory
  std::vector<Total> totals_;                                  // sent, by robot
  std::size_t bytes_ = 0;  // sent by the session, with the overhead of messages
  std::size_t max_bytes_;
  std::size_t cleared_ = 0;  // [bytes] since `sent_` last gave its memory back
  unsigned to_release_ = 0;  // of `sent_` and the list of the last command, which take turns
};

namespace {

void check_limit(std::size_t value, std::size_t max, const std::string& radio, const char* who,
                 const char* unit) {
  if (value <= max) return;
  throw std::length_error("radio '" + text::printable_part(radio) + "': " + std::string(who) +
                          " sends " + std::to_string(value) + unit + " at this tick; at most " +
                          std::to_string(max) + " are allowed");
}

}  // namespace

void RadioTraffic::send(const std::string& radio, std::uint32_t index, std::uint32_t robot,
                        Bytes message) {
  constexpr std::size_t overhead =
      96;  // of a message besides its payload: its fields count, too [bytes]
  if (message.size() > Radio::max_message_bytes) {
    throw std::length_error("radio '" + text::printable_part(radio) + "': a message of " +
                            std::to_string(message.size()) + " bytes; at most " +
                            std::to_string(Radio::max_message_bytes) + " are allowed");
  }
  Total total = totals_[robot];
  total.messages += 1;
  total.bytes += message.size();
  const std::size_t bytes = bytes_ + message.size() + overhead;
  check_limit(total.bytes, Radio::max_bytes_per_robot, radio, "the robot", " bytes");
  check_limit(total.messages, Radio::max_messages_per_robot, radio, "the robot", " messages");
  check_limit(bytes, max_bytes_, radio, "this session", " bytes by radio");
  v1::RadioMessage& to = *sent_.Add();
  to.set_radio(index);
  to.mutable_payload()->assign(reinterpret_cast<const char*>(message.data()), message.size());
  totals_[robot] = total;
  bytes_ = bytes;
}

void RadioTraffic::check(const v1::Observation& from) const {
  for (const v1::RadioMessage& message : from.radio_messages()) {
    if (message.radio() < received_.size() && received_[message.radio()] != nullptr) continue;
    throw std::runtime_error("the server sent a message for radio " +
                             std::to_string(message.radio()) + ", which receives nothing");
  }
}

void RadioTraffic::read(const v1::Observation& from) {
  for (std::vector<Bytes>* received : received_) {
    if (received != nullptr) received->clear();
  }
  for (const v1::RadioMessage& message : from.radio_messages()) {
    received_[message.radio()]->push_back(bytes_of(message.payload()));
  }
}

void RadioTraffic::reset() {
  constexpr std::size_t max_kept = std::size_t{64} << 20;
  sent_.Clear();
  std::fill(totals_.begin(), totals_.end(), Total{});
  cleared_ += bytes_;
  bytes_ = 0;
  if (cleared_ >= max_kept) {
    to_release_ = 2;
    cleared_ = 0;
  }
  if (to_release_ == 0) return;
  --to_release_;
  google::protobuf::RepeatedPtrField<v1::RadioMessage>().Swap(&sent_);
}

void Layout::add_radios() {
  auto& traffic = add(RadioTraffic(robots.size(), welcome.max_message_bytes() / 2));
  each_robot([&](const v1::RobotDescription& robot, Robot& to) {
    to.radios_.reserve(size(robot.radios_size()));
    for (const v1::RadioDescription& from : robot.radios()) {
      Radio& radio = to.radios_.emplace_back();
      radio.id_ = from.id();
      radio.range_ = from.range();
      radio.receives_ = from.receives();
      radio.traffic_ = from.sends() ? &traffic : nullptr;
      radio.index_ = traffic.add(from.receives() ? &radio.received_ : nullptr);
      radio.robot_ = to.position_;
    }
  });
}

void Radio::send(Bytes message) {
  if (traffic_ == nullptr) {
    throw std::logic_error("radio '" + text::printable_part(id_) +
                           "' does not send: the controller's <actuators> have no radios");
  }
  traffic_->send(id_, index_, robot_, message);
}

}  // namespace ziggurat
