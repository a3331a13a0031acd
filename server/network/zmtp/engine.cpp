#include "network/zmtp/engine.h"

#include <algorithm>
#include <array>

namespace ziggurat::network::zmtp {
namespace {

using Step = Taken::Step;

constexpr std::size_t greeting_size = 64;
constexpr std::size_t signature_size = 10, mechanism_at = 12, mechanism_size = 20;
constexpr std::uint8_t major_version = 3, minor_version = 1;
constexpr std::size_t longest_command = 2048;  // [bytes] of the handshake, properties included
constexpr std::size_t longest_ping_context = 16;

std::string_view mechanism_of(const CurveKeys* keys) { return keys == nullptr ? "NULL" : "CURVE"; }

Taken failed() { return {Step::failed, 0, false, {}}; }

}  // namespace

Engine::Engine(const CurveKeys* keys) : keys_(keys) {
  if (keys != nullptr) curve_.emplace(*keys);
}

std::string Engine::greeting() const {
  std::string greeting(greeting_size, '\0');
  greeting[0] = '\xff';
  greeting[8] = 1;  // what older versions take for a length
  greeting[9] = '\x7f';
  greeting[10] = major_version;
  greeting[11] = minor_version;
  std::ranges::copy(mechanism_of(keys_), greeting.begin() + mechanism_at);
  greeting[mechanism_at + mechanism_size] = keys_ == nullptr ? 0 : 1;  // we are the server
  return greeting;
}

Access Engine::access() const {
  if (!curve_) return {};
  return {keys_->roles(curve_->client()), curve_->client()};
}

/// Refuses early what begins otherwise, such as HTTP.
Taken Engine::take_greeting(Bytes input, std::string& reply) {
  const bool begins_well = input.empty() || input[0] == 0xff;
  const bool is_signed = input.size() < signature_size || (input[signature_size - 1] & 1) != 0;
  const bool is_new = input.size() <= signature_size || input[signature_size] >= major_version;
  if (!begins_well || !is_signed || !is_new) return failed();
  if (input.size() < greeting_size) return {Step::incomplete, greeting_size, false, {}};
  const std::string_view mechanism = text_of(input.subspan(mechanism_at, mechanism_size));
  std::string ours(mechanism_of(keys_));
  ours.resize(mechanism_size);
  if (mechanism != ours) {
    refusal_ = curve_ ? "it has no key, and the endpoint is protected (--curve-clients)"
                      : "it has keys, and the endpoint is not protected";
    return failed();
  }
  stage_ = curve_ ? Stage::hello : Stage::ready;
  if (!curve_) append_command(reply, "READY", our_metadata());
  return {Step::passed, greeting_size, false, {}};
}

bool Engine::take_handshake(Bytes body, std::string& reply) {
  if (stage_ == Stage::hello) {
    stage_ = Stage::ready;
    const bool is_ours = curve_->hello(body, reply);
    if (!is_ours) refusal_ = "it expects another server key";
    return is_ours;
  }
  stage_ = Stage::open;
  if (curve_) {
    const bool is_listed = curve_->initiate(body, reply);
    if (const auto& key = curve_->unlisted_key(); !key.empty()) {
      refusal_ = "its key " + key + " is not in --curve-clients";
    }
    return is_listed;
  }
  const auto data = command_data(body, "READY");
  return data && is_of_client(read_metadata(*data));
}

Taken Engine::take(std::span<std::uint8_t> input, std::size_t limit, std::string& reply) {
  if (stage_ == Stage::greeting) return take_greeting(input, reply);
  const auto header = read_header(input);
  if (!header) return {Step::incomplete, longest_header, false, {}};
  if (!header->is_valid) return failed();
  const std::size_t around = curve_ ? CurvePeer::overhead : 0;
  const bool is_traffic = is_open() && !header->is_command;
  const std::size_t most = is_traffic ? limit + around : longest_command;
  if (header->body > most) {
    const bool fits = header->body < SIZE_MAX / 2;
    if (!is_traffic || !fits) return failed();
    return {Step::too_long,
            header->length + static_cast<std::size_t>(header->body),
            header->has_more,
            {}};
  }
  const std::size_t size = header->length + static_cast<std::size_t>(header->body);
  if (input.size() < size) return {Step::incomplete, size, false, {}};
  const auto body = input.subspan(header->length, static_cast<std::size_t>(header->body));
  if (is_open()) return take_traffic(*header, body, size, reply);
  if (!take_handshake(body, reply)) return failed();
  return {Step::passed, size, false, {}};
}

Taken Engine::take_traffic(const Header& header, std::span<std::uint8_t> body, std::size_t size,
                           std::string& reply) {
  CurvePeer::Opened opened{body, header.has_more, header.is_command};
  if (curve_) {
    const auto box = curve_->open(body);
    if (!box) return failed();
    opened = *box;
  }
  if (!opened.is_command) return {Step::frame, size, opened.has_more, opened.content};
  take_command(opened.content, reply);
  return {Step::passed, size, false, {}};
}

/// A PING is answered, the others say nothing to a ROUTER.
void Engine::take_command(Bytes body, std::string& reply) {
  constexpr std::size_t time_to_live = 2;
  const auto ping = command_data(body, "PING");
  if (!ping || ping->size() < time_to_live) return;
  const Bytes context = ping->subspan(time_to_live);
  const auto echoed = text_of(context.first(std::min(context.size(), longest_ping_context)));
  if (!curve_) return append_command(reply, "PONG", echoed);
  std::string pong = "\x04PONG";
  pong += echoed;
  const std::size_t at = content_at(pong.size());
  std::string frame(at + pong.size(), '\0');
  std::ranges::copy(pong, frame.begin() + static_cast<std::ptrdiff_t>(at));
  const std::span bytes(reinterpret_cast<std::uint8_t*>(frame.data()), frame.size());
  const std::size_t body_size = CurvePeer::overhead + pong.size();
  write_header(body_size, bytes.data());
  curve_->seal(bytes.last(body_size), true);
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
