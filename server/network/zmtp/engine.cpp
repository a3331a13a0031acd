// SPDX-License-Identifier: MIT
#include "network/zmtp/engine.h"

#include <algorithm>
#include <utility>

namespace ziggurat::network::zmtp {
namespace {

using Step = Taken::Step;

constexpr const char* not_a_frame = "a frame of its is none of ZMTP 3";

std::string_view mechanism_for(const CurveKeys* keys) { return keys == nullptr ? "NULL" : "CURVE"; }

/// Reason to refuse a client because of its metadata; empty: it is accepted.
std::string refusal_of(const Metadata& metadata) {
  constexpr std::size_t longest_type = 16;
  if (!metadata.is_valid) return "its metadata are none of ZMTP 3";
  const std::string type = metadata.socket_type.substr(0, longest_type);
  return "it is a socket of type " + (type.empty() ? "none" : type) +
         ", and the server talks with a DEALER";
}

}  // namespace

Engine::Engine(const CurveKeys* keys) : keys_(keys) {
  if (keys != nullptr) curve_.emplace(*keys);
}

std::string Engine::greeting() const {
  return zmtp::greeting(mechanism_for(keys_), End::server).substr(0, first_of_greeting);
}

Taken Engine::fail(std::string why) {
  refusal_ = std::move(why);
  return {.step = Step::failed};
}

Access Engine::access() const {
  if (!curve_) return {};
  return {keys_->roles(curve_->client()), curve_->client()};
}

/// Refuses early what begins otherwise, such as HTTP.
Taken Engine::take_greeting(Bytes input, std::string& reply) {
  const Greeting found = check_greeting(input);
  if (found == Greeting::wrong) {
    const std::string version(older_version(input));
    return fail(version.empty()
                    ? "what it sends is not ZMTP 3, ZeroMQ's wire protocol"
                    : "it speaks ZMTP " + version + ", and ZMTP 3 is needed (libzmq 4)");
  }
  if (found == Greeting::incomplete) return {.step = Step::incomplete, .size = greeting_size};
  // The rest follows the client's whole greeting: a client that breaks off at our mechanism has
  // told its own.
  reply += zmtp::greeting(mechanism_for(keys_), End::server).substr(first_of_greeting);
  const std::string mechanism(mechanism_of(input));
  if (mechanism == mechanism_for(keys_)) {
    stage_ = curve_ ? Stage::hello : Stage::ready;
    return {.step = Step::passed, .size = greeting_size};
  }
  if (mechanism == "NULL")
    return fail("it has no key, and the endpoint is protected (--curve-clients)");
  if (mechanism == "CURVE") return fail("it has keys, and the endpoint is not protected");
  return fail("its mechanism is " + mechanism + ", and the endpoint's is " +
              std::string(mechanism_for(keys_)));
}

/// @return  why it has failed; empty if it has not
std::string Engine::take_handshake(Bytes body, std::string& reply) {
  if (stage_ == Stage::hello) {
    if (!curve_->hello(body, reply)) return "it expects another server key";
    stage_ = Stage::ready;
    return {};
  }
  if (curve_) {
    if (curve_->initiate(body, reply)) {
      stage_ = Stage::open;
      return {};
    }
    if (const auto& key = curve_->unlisted_key(); !key.empty())
      return "its key " + key + " is not in --curve-clients";
    return curve_->refused_metadata() ? refusal_of(*curve_->refused_metadata())
                                      : "its handshake is none of CURVE";
  }
  const auto data = command_data(body, "READY");
  const Metadata metadata = data ? read_metadata(*data) : Metadata{};
  if (!is_of_client(metadata)) return refusal_of(metadata);
  // Not earlier: a socket of another type closes the connection when it has ours, before it tells
  // its own.
  append_command(reply, "READY", metadata_of("ROUTER"));
  stage_ = Stage::open;
  return {};
}

Taken Engine::take(std::span<std::uint8_t> input, std::size_t limit, std::string& reply) {
  if (stage_ == Stage::greeting) return take_greeting(input, reply);
  const auto header = read_header(input);
  if (!header) return {.step = Step::incomplete, .size = longest_header};
  if (!header->is_valid) return fail(not_a_frame);
  const std::size_t around = curve_ ? CurvePeer::overhead : 0;
  const bool is_traffic = is_open() && !header->is_command;
  const std::size_t most = is_traffic ? limit + around : longest_command;
  if (header->body > most) {
    const bool fits = header->body < SIZE_MAX / 2;
    if (!is_traffic || !fits) return fail(not_a_frame);
    return {Step::too_long,
            header->length + static_cast<std::size_t>(header->body),
            header->has_more,
            {}};
  }
  const std::size_t size = header->length + static_cast<std::size_t>(header->body);
  if (input.size() < size) return {.step = Step::incomplete, .size = size};
  const auto body = input.subspan(header->length, static_cast<std::size_t>(header->body));
  if (is_open()) return take_traffic(*header, body, size, reply);
  if (std::string why = take_handshake(body, reply); !why.empty()) return fail(std::move(why));
  return {.step = Step::passed, .size = size};
}

Taken Engine::take_traffic(const Header& header, std::span<std::uint8_t> body, std::size_t size,
                           std::string& reply) {
  CurvePeer::Opened opened{body, header.has_more, header.is_command};
  if (curve_) {
    const auto box = curve_->open(body);
    if (!box) return fail("a box of its can't be opened");
    opened = *box;
  }
  if (!opened.is_command) return {Step::frame, size, opened.has_more, opened.content};
  take_command(opened.content, reply);
  return {.step = Step::passed, .size = size};
}

/// A PING is answered, the others say nothing to a ROUTER.
void Engine::take_command(Bytes body, std::string& reply) {
  const auto context = ping_context(body);
  if (!context) return;
  if (!curve_) return append_command(reply, "PONG", text_of(*context));
  std::string pong = "\x04PONG";
  pong += text_of(*context);
  const std::size_t at = content_at(pong.size());
  std::string frame(at + pong.size(), '\0');
  std::ranges::copy(pong, frame.begin() + static_cast<std::ptrdiff_t>(at));
  const std::span bytes(reinterpret_cast<std::uint8_t*>(frame.data()), frame.size());
  const std::size_t body_size = CurvePeer::overhead + pong.size();
  write_header(body_size, bytes.data());
  curve_->seal(bytes.last(body_size), CurvePeer::Content::command);
  reply += frame;
}

std::size_t Engine::content_at(std::size_t content) const {
  const std::size_t around = curve_ ? CurvePeer::overhead : 0;
  return header_length(content + around) + around;
}

void Engine::seal(std::span<std::uint8_t> frame, std::size_t content) {
  const std::size_t body = content + (curve_ ? CurvePeer::overhead : 0);
  write_header(body, frame.data());
  if (curve_) curve_->seal(frame.last(body));
}

}  // namespace ziggurat::network::zmtp
