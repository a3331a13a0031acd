// SPDX-License-Identifier: MIT
// Parsing of the frames from the server; no sockets.

#include <optional>
#include <string_view>

#include "connection.h"
#include "ziggurat/error.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {

/// Protobuf keeps memory for the largest value that each part ever had: after many bytes the
/// long-lived messages release it.
void Connection::forget(std::size_t size) {
  constexpr std::size_t max_parsed = std::size_t{64} << 20;
  parsed_ += size;
  if (parsed_ < max_parsed) return;
  parsed_ = size;
  v1::Observation().Swap(&observation_);
  v1::WorldState().Swap(&world_state_);
}

Connection::Kind Connection::parse() {
  silence_ = std::chrono::milliseconds{0};
  const std::string_view bytes = transport_->content();
  std::string_view content = bytes;
  google::protobuf::Message* message = &message_;
  Kind kind = Kind::MESSAGE_NOT_SET;
  if (const auto observation = v1::sole_field(bytes, v1::ServerMessage::kObservationFieldNumber)) {
    content = *observation;
    message = &observation_;
    kind = Kind::kObservation;
  } else if (const auto state = v1::sole_field(bytes, v1::ServerMessage::kWorldStateFieldNumber)) {
    content = *state;
    message = &world_state_;
    kind = Kind::kWorldState;
  }
  if (message == &message_) {
    v1::ServerMessage().Swap(&message_);  // others are rare: their memory is free
  } else {
    forget(content.size());
  }
  if (transport_->has_more() ||
      !message->ParseFromArray(content.data(), static_cast<int>(content.size()))) {
    throw ConnectionError(
        options_.endpoint +
        ": the answer is not a message of ziggurat.v1; is this the endpoint of a server?");
  }
  if (message != &message_) return kind;
  if (message_.has_observation()) observation_.Swap(message_.mutable_observation());
  if (message_.has_world_state()) world_state_.Swap(message_.mutable_world_state());
  return message_.message_case();
}

}  // namespace ziggurat
