// Parsing of the frames from the server; no sockets.

#include <limits>
#include <optional>
#include <string>

#include "connection.h"
#include "ziggurat/error.h"
#include "ziggurat/v1/extent.h"
#include "ziggurat/v1/envelope.h"

namespace ziggurat {

namespace {

// A message is decoded up to these: a hostile one of a few bytes for each field would take all memory. Welcomes of
// ten thousand robots with a hundred fields each are half of that. What is sent at each tick has the server's own bound.
constexpr std::size_t longest_welcome = v1::longest_sent_once;  // and of all else that is sent once [bytes]
constexpr std::size_t most_fields = v1::most_fields_sent_once;
constexpr std::size_t cheap = std::size_t{1} << 20;  // so few bytes have few fields

/// The content of a message that is a WorldLayout.
std::optional<std::string_view> layout_in(std::string_view content, const google::protobuf::Message& message) {
  if (message.GetDescriptor() != v1::ServerMessage::descriptor()) return std::nullopt;
  return v1::sole_field(content, v1::ServerMessage::kWorldLayoutFieldNumber);
}

/// Fault of a message whose decoding costs too much; empty: none.
std::string excess(std::string_view content, const google::protobuf::Message& message) {
  if (content.size() <= cheap) return {};
  const auto& type = *message.GetDescriptor();
  if (layout_in(content, message)) return {};  // all that were told count together
  if (&type == v1::ServerMessage::descriptor() && content.size() > longest_welcome) {
    return "a message of " + std::to_string(content.size()) + " bytes, more than " + std::to_string(longest_welcome);
  }
  if (&type != v1::ServerMessage::descriptor()) {
    if (v1::decoded_size(content, type, v1::most_decoded) <= v1::most_decoded) return {};
    return "a message that takes more than " + std::to_string(v1::most_decoded) + " bytes of memory";
  }
  if (v1::count_fields(content, type, most_fields) <= most_fields) return {};
  return "a message of more than " + std::to_string(most_fields) + " fields";
}

}  // namespace

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

void Connection::throw_too_much_laid_out() const {
  throw ConnectionError(options_.endpoint + ": the server told of entities that take more than " +
                        std::to_string(v1::most_laid_out) + " bytes of memory, which this client does not decode: let the "
                        "director see fewer");
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
  if (message != &message_) forget(content.size());
  if (const std::string fault = excess(content, *message); !fault.empty()) {
    throw ConnectionError(options_.endpoint + ": the server sent " + fault + ", which this client does not decode: "
                          "run fewer robots in each session (--lua-processes for scripts), or let them hear and see less");
  }
  const auto layout = layout_in(content, *message);
  const std::size_t layout_size =
      layout ? v1::decoded_size(*layout, *v1::WorldLayout::descriptor(), v1::most_laid_out) : 0;
  if (layout_size > v1::most_laid_out) throw_too_much_laid_out();
  if (message == &message_ && message_size_ > cheap) v1::ServerMessage().Swap(&message_);  // its memory is free
  if (message == &message_) message_size_ = content.size();
  constexpr std::size_t longest = std::numeric_limits<int>::max();
  if (transport_->has_more() || content.size() > longest ||
      !message->ParseFromArray(content.data(), static_cast<int>(content.size()))) {
    throw ConnectionError(
        options_.endpoint +
        ": the answer is not a message of ziggurat.v1; is this the endpoint of a server?");
  }
  if (message != &message_) return kind;
  if (layout && message_.has_world_layout()) {
    laid_out_ = layout_size + (message_.world_layout().first() == 0 ? 0 : laid_out_);
    if (laid_out_ > v1::most_laid_out) throw_too_much_laid_out();
  }
  if (message_.has_observation()) observation_.Swap(message_.mutable_observation());
  if (message_.has_world_state()) world_state_.Swap(message_.mutable_world_state());
  return message_.message_case();
}

}  // namespace ziggurat
