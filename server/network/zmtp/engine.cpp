#include "network/zmtp/engine.h"

#include <algorithm>

namespace ziggurat::network::zmtp {
namespace {

using Step = Taken::Step;

std::string_view mechanism_for(const CurveKeys* keys) { return keys == nullptr ? "NULL" : "CURVE"; }

Taken failed() { return {Step::failed, 0, false, {}}; }

}  // namespace

Engine::Engine(const CurveKeys* keys) : keys_(keys) {
  if (keys != nullptr) curve_.emplace(*keys);
}

std::string Engine::greeting() const { return zmtp::greeting(mechanism_for(keys_), true); }

Access Engine::access() const {
  if (!curve_) return {};
  return {keys_->roles(curve_->client()), curve_->client()};
}

/// Refuses early what begins otherwise, such as HTTP.
Taken Engine::take_greeting(Bytes input, std::string& reply) {
  const Greeting found = check_greeting(input);
  if (found == Greeting::wrong) return failed();
  if (found == Greeting::incomplete) return {Step::incomplete, greeting_size, false, {}};
  if (mechanism_of(input) != mechanism_for(keys_)) {
    refusal_ = curve_ ? "it has no key, and the endpoint is protected (--curve-clients)"
                      : "it has keys, and the endpoint is not protected";
    return failed();
  }
  stage_ = curve_ ? Stage::hello : Stage::ready;
  if (!curve_) append_command(reply, "READY", metadata_of("ROUTER"));
  return {Step::passed, greeting_size, false, {}};
}

bool Engine::take_handshake(Bytes body, std::string& reply) {
  if (stage_ == Stage::hello) {
    const bool is_ours = curve_->hello(body, reply);
    if (is_ours) stage_ = Stage::ready;
    if (!is_ours) refusal_ = "it expects another server key";
    return is_ours;
  }
  if (!curve_) {
    const auto data = command_data(body, "READY");
    if (!data || !is_of_client(read_metadata(*data))) return false;
  } else if (!curve_->initiate(body, reply)) {
    if (const auto& key = curve_->unlisted_key(); !key.empty()) {
      refusal_ = "its key " + key + " is not in --curve-clients";
    }
    return false;
  }
  stage_ = Stage::open;
  return true;
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
