// Parsing of the frames from the server; no sockets.

#include "connection.h"
#include "ziggurat/error.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {

/// Protobuf keeps memory for the largest value that each part ever had: after many bytes the
/// observation releases it.
void Connection::forget(std::size_t size) {
  constexpr std::size_t max_parsed = std::size_t{64} << 20;
  parsed_ += size;
  if (parsed_ < max_parsed) return;
  parsed_ = size;
  v1::Observation().Swap(&observation_);
}

Connection::Kind Connection::parse() {
  silence_ = std::chrono::milliseconds{0};
  const std::string_view bytes = transport_->content();
  const auto observation = v1::sole_field(bytes, v1::ServerMessage::kObservationFieldNumber);
  const std::string_view content = observation.value_or(bytes);
  if (observation) forget(content.size());
  google::protobuf::MessageLite& message =
      observation ? static_cast<google::protobuf::MessageLite&>(observation_) : message_;
  if (transport_->has_more() || !message.ParseFromArray(content.data(), static_cast<int>(content.size()))) {
    throw ConnectionError(
        options_.endpoint +
        ": the answer is not a message of ziggurat.v1; is this the endpoint of a server?");
  }
  if (observation) return Kind::kObservation;
  if (message_.has_observation()) observation_.Swap(message_.mutable_observation());
  return message_.message_case();
}

}  // namespace ziggurat
