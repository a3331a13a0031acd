// SPDX-License-Identifier: MIT
#include "network/zmtp/curve.h"

#include <sodium.h>
#include <zmq.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace ziggurat::network::zmtp {
namespace {

constexpr std::size_t key_size = 32, mac_size = 16, number_size = 8, long_nonce_size = 16;
constexpr std::size_t signed_zeros = 64;  // in a HELLO
constexpr std::string_view message_name = "\x07MESSAGE";
constexpr std::uint8_t more_in_box = 1, command_in_box = 2;

static_assert(CurvePeer::overhead == message_name.size() + number_size + mac_size + 1);

using Nonce = std::array<std::uint8_t, 24>;

/// A name and a number, or a name and random bytes: 24 bytes in all.
Nonce make_nonce(std::string_view name, Bytes rest) {
  Nonce nonce{};
  std::ranges::copy(name, nonce.begin());
  std::ranges::copy(rest, nonce.begin() + static_cast<std::ptrdiff_t>(name.size()));
  return nonce;
}

std::uint64_t number_of(Bytes bytes) {
  std::uint64_t number = 0;
  for (const std::uint8_t byte : bytes.first(number_size)) number = number << 8 | byte;
  return number;
}

std::array<std::uint8_t, number_size> bytes_of_number(std::uint64_t number) {
  std::array<std::uint8_t, number_size> bytes;
  for (std::size_t i = number_size; i-- > 0; number >>= 8) {
    bytes[i] = static_cast<std::uint8_t>(number);
  }
  return bytes;
}

Key key_of(Bytes bytes) {
  Key key;
  std::ranges::copy(bytes.first(key_size), key.begin());
  return key;
}

/// Shared key that seals and opens the boxes between two keys; computing it is the most expensive
/// step. None if the other key is a weak one, which no client makes.
std::optional<Key> shared_by(const Key& theirs, const Key& ours) {
  Key shared;
  const int result = ::crypto_box_beforenm(shared.data(), theirs.data(), ours.data());
  return result == 0 ? std::optional(shared) : std::nullopt;
}

/// The content of a box; none if it is not the work of both keys.
std::optional<std::vector<std::uint8_t>> open_box(Bytes box, const Nonce& nonce,
                                                  const std::optional<Key>& shared) {
  if (box.size() < mac_size || !shared) return std::nullopt;
  std::vector<std::uint8_t> content(box.size() - mac_size);
  const int result = ::crypto_box_open_easy_afternm(content.data(), box.data(), box.size(),
                                                    nonce.data(), shared->data());
  return result == 0 ? std::optional(std::move(content)) : std::nullopt;
}

Key decode(const std::string& z85) {
  Key key;
  if (zmq_z85_decode(key.data(), z85.c_str()) == nullptr) throw std::logic_error("not a key");
  return key;
}

}  // namespace

CurveKeys::CurveKeys(const Curve& config) : secret_(decode(config.secret_key)) {
  if (::sodium_init() < 0) throw std::runtime_error("libsodium can't be used on this machine");
  ::crypto_scalarmult_base(public_.data(), secret_.data());
  for (const ClientKey& client : config.clients) {
    const Key key = decode(client.public_key);
    clients_.emplace(std::string(key.begin(), key.end()), roles_.size());
    roles_.push_back(client.roles);
  }
}

std::optional<std::size_t> CurveKeys::client(const Key& public_key) const {
  const auto found = clients_.find(std::string(public_key.begin(), public_key.end()));
  return found == clients_.end() ? std::nullopt : std::optional(found->second);
}

bool CurvePeer::is_fresh(std::uint64_t nonce) {
  if (nonce <= received_) return false;
  received_ = nonce;
  return true;
}

// HELLO: version 1.0, 72 zeros, the client's transient key, a number, a box with zeros.
// WELCOME: random bytes, a box with our transient key and a cookie.
bool CurvePeer::hello(Bytes body, std::string& reply) {
  const auto data = command_data(body, "HELLO");
  constexpr std::size_t key_at = 74, number_at = key_at + key_size, box_at = number_at + 8;
  if (!data || data->size() != box_at + signed_zeros + mac_size) return false;
  if ((*data)[0] != 1 || (*data)[1] != 0) return false;
  client_transient_ = key_of(data->subspan(key_at));
  const Bytes number = data->subspan(number_at, number_size);
  const auto shared = shared_by(client_transient_, keys_.secret_key());
  const auto zeros =
      open_box(data->subspan(box_at), make_nonce("CurveZMQHELLO---", number), shared);
  if (!zeros || !is_fresh(number_of(number))) return false;
  ::crypto_box_keypair(our_transient_public_.data(), our_transient_secret_.data());
  ::randombytes_buf(cookie_.data(), cookie_.size());
  std::array<std::uint8_t, long_nonce_size> nonce;
  ::randombytes_buf(nonce.data(), nonce.size());
  std::array<std::uint8_t, key_size + 96> content;
  std::ranges::copy(our_transient_public_, content.begin());
  std::ranges::copy(cookie_, content.begin() + key_size);
  std::array<std::uint8_t, mac_size + content.size()> box;
  ::crypto_box_easy_afternm(box.data(), content.data(), content.size(),
                            make_nonce("WELCOME-", nonce).data(), shared->data());
  append_command(reply, "WELCOME", std::string(text_of(nonce)) + std::string(text_of(box)));
  return true;
}

// INITIATE: the cookie, a number, a box with the client's key, a vouch for its transient one and
// metadata. READY: a number, a box with our metadata.
bool CurvePeer::initiate(Bytes body, std::string& reply) {
  const auto data = command_data(body, "INITIATE");
  constexpr std::size_t vouch_size = 2 * key_size + mac_size;
  constexpr std::size_t least = key_size + long_nonce_size + vouch_size;
  const std::size_t box_at = cookie_.size() + number_size;
  if (!data || data->size() < box_at + mac_size + least) return false;
  if (::sodium_memcmp(data->data(), cookie_.data(), cookie_.size()) != 0) return false;
  const Bytes number = data->subspan(cookie_.size(), number_size);
  const auto shared = shared_by(client_transient_, our_transient_secret_);
  const auto content =
      open_box(data->subspan(box_at), make_nonce("CurveZMQINITIATE", number), shared);
  if (!content || !is_fresh(number_of(number))) return false;
  const Key client_key = key_of(*content);
  const Bytes vouch_nonce = Bytes(*content).subspan(key_size, long_nonce_size);
  const auto vouched =
      open_box(Bytes(*content).subspan(key_size + long_nonce_size, vouch_size),
               make_nonce("VOUCH---", vouch_nonce), shared_by(client_key, our_transient_secret_));
  const bool is_vouched =
      vouched && ::sodium_memcmp(vouched->data(), client_transient_.data(), key_size) == 0 &&
      ::sodium_memcmp(vouched->data() + key_size, keys_.public_key().data(), key_size) == 0;
  if (!is_vouched) return false;
  const auto client = keys_.client(client_key);
  if (!client) {
    append_command(reply, "ERROR",
                   "\x03"
                   "400");
    std::array<char, 41> text{};
    unlisted_key_ = zmq_z85_encode(text.data(), client_key.data(), client_key.size());
    return false;
  }
  client_ = *client;
  Metadata metadata = read_metadata(Bytes(*content).subspan(least));
  if (!is_of_client(metadata)) {
    refused_metadata_ = std::move(metadata);
    return false;
  }
  shared_ = *shared;
  const auto our_number = bytes_of_number(++sent_);
  const std::string ours = metadata_of("ROUTER");
  std::string box(ours.size() + mac_size, '\0');
  ::crypto_box_easy_afternm(reinterpret_cast<std::uint8_t*>(box.data()), bytes_of(ours).data(),
                            ours.size(), make_nonce("CurveZMQREADY---", our_number).data(),
                            shared_.data());
  append_command(reply, "READY", std::string(text_of(our_number)) + box);
  return true;
}

std::optional<CurvePeer::Opened> CurvePeer::open(std::span<std::uint8_t> body) {
  const bool is_message =
      body.size() >= overhead && text_of(body.first(message_name.size())) == message_name;
  if (!is_message) return std::nullopt;
  const Bytes number = body.subspan(message_name.size(), number_size);
  if (!is_fresh(number_of(number))) return std::nullopt;
  const auto box = body.subspan(message_name.size() + number_size);
  const auto content = box.subspan(mac_size);
  const int result =
      ::crypto_box_open_easy_afternm(content.data(), box.data(), box.size(),
                                     make_nonce("CurveZMQMESSAGEC", number).data(), shared_.data());
  if (result != 0) return std::nullopt;
  return Opened{content.subspan(1), (content[0] & more_in_box) != 0,
                (content[0] & command_in_box) != 0};
}

void CurvePeer::seal(std::span<std::uint8_t> body, Content kind) {
  std::ranges::copy(message_name, body.begin());
  const auto number = bytes_of_number(++sent_);
  std::ranges::copy(number, body.begin() + message_name.size());
  const auto box = body.subspan(message_name.size() + number_size);
  const auto content = box.subspan(mac_size);
  content[0] = kind == Content::command ? command_in_box : 0;
  ::crypto_box_easy_afternm(box.data(), content.data(), content.size(),
                            make_nonce("CurveZMQMESSAGES", number).data(), shared_.data());
}

}  // namespace ziggurat::network::zmtp
