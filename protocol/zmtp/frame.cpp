// SPDX-License-Identifier: MIT
#include "zmtp/frame.h"

#include <algorithm>
#include <cctype>

namespace ziggurat::zmtp {
namespace {

constexpr std::uint8_t more_flag = 1, long_flag = 2, command_flag = 4;
constexpr std::size_t signature_size = 10, mechanism_at = 12, mechanism_size = 20;
constexpr std::uint8_t major_version = 3, minor_version = 1;
constexpr std::size_t short_body = 255;  // [bytes] and less: the size has one byte

/// A number whose highest byte comes first.
std::uint64_t read_number(Bytes bytes) {
  std::uint64_t number = 0;
  for (const std::uint8_t byte : bytes) number = number << 8 | byte;
  return number;
}

void write_number(std::uint64_t number, std::size_t bytes, std::uint8_t* to) {
  for (std::size_t i = bytes; i-- > 0; number >>= 8) to[i] = static_cast<std::uint8_t>(number);
}

bool are_equal_without_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char one, unsigned char two) {
    return std::tolower(one) == std::tolower(two);
  });
}

void append_property(std::string& to, std::string_view name, std::string_view value) {
  std::uint8_t size[4];
  write_number(value.size(), sizeof size, size);
  to += static_cast<char>(name.size());
  to += name;
  to += text_of(size);
  to += value;
}

}  // namespace

std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string greeting(std::string_view mechanism, End end) {
  std::string greeting(greeting_size, '\0');
  greeting[0] = '\xff';
  greeting[8] = 1;  // what older versions take for a length
  greeting[9] = '\x7f';
  greeting[10] = major_version;
  greeting[11] = minor_version;
  std::ranges::copy(mechanism, greeting.begin() + mechanism_at);
  greeting[mechanism_at + mechanism_size] = end == End::server && mechanism != "NULL" ? 1 : 0;
  return greeting;
}

Greeting check_greeting(Bytes input) {
  const bool begins_well = input.empty() || input[0] == 0xff;
  const bool is_signed = input.size() < signature_size || (input[signature_size - 1] & 1) != 0;
  const bool is_new = input.size() <= signature_size || input[signature_size] >= major_version;
  if (!begins_well || !is_signed || !is_new) return Greeting::wrong;
  return input.size() < greeting_size ? Greeting::incomplete : Greeting::whole;
}

std::string_view older_version(Bytes input) {
  if (check_greeting(input) != Greeting::wrong) return {};
  const bool has_version = input.size() > signature_size && input[0] == 0xff;
  if (has_version) return input[signature_size] == 0 ? "1.0" : "2.0";
  // Before version 2 a connection begins with the frame of a routing id, mostly an empty one.
  return input.size() >= 2 && input[0] == 1 && input[1] == 0 ? "1.0" : std::string_view();
}

std::string_view mechanism_of(Bytes greeting) {
  const std::string_view padded = text_of(greeting.subspan(mechanism_at, mechanism_size));
  return padded.substr(0, padded.find_last_not_of('\0') + 1);
}

std::optional<Header> read_header(Bytes input) {
  if (input.empty()) return std::nullopt;
  const std::uint8_t flags = input[0];
  Header header;
  header.has_more = (flags & more_flag) != 0;
  header.is_command = (flags & command_flag) != 0;
  header.is_valid = (flags & ~(more_flag | long_flag | command_flag)) == 0;
  header.length = (flags & long_flag) != 0 ? longest_header : 2;
  if (input.size() < header.length) return header.is_valid ? std::nullopt : std::optional(header);
  header.body = read_number(input.subspan(1, header.length - 1));
  return header;
}

std::size_t header_length(std::size_t body) { return body > short_body ? longest_header : 2; }

void write_header(std::size_t body, std::uint8_t* to) {
  const std::size_t length = header_length(body);
  to[0] = length == longest_header ? long_flag : 0;
  write_number(body, length - 1, to + 1);
}

void append_command(std::string& to, std::string_view name, std::string_view data) {
  const std::size_t body = 1 + name.size() + data.size();
  std::uint8_t header[longest_header];
  write_header(body, header);
  header[0] |= command_flag;
  to += text_of({header, header_length(body)});
  to += static_cast<char>(name.size());
  to += name;
  to += data;
}

std::optional<Bytes> command_data(Bytes body, std::string_view name) {
  const bool is_it = body.size() > name.size() && body[0] == name.size() &&
                     text_of(body.subspan(1, name.size())) == name;
  if (!is_it) return std::nullopt;
  return body.subspan(1 + name.size());
}

Metadata read_metadata(Bytes data) {
  Metadata metadata;
  while (!data.empty()) {
    const std::size_t name_size = data[0];
    if (data.size() < 1 + name_size + 4) return {};
    const std::string_view name = text_of(data.subspan(1, name_size));
    const std::uint64_t size = read_number(data.subspan(1 + name_size, 4));
    data = data.subspan(1 + name_size + 4);
    if (data.size() < size) return {};
    if (are_equal_without_case(name, "Socket-Type")) {
      metadata.socket_type = text_of(data.first(static_cast<std::size_t>(size)));
    }
    data = data.subspan(static_cast<std::size_t>(size));
  }
  metadata.is_valid = true;
  return metadata;
}

bool is_of_client(const Metadata& metadata) {
  const std::string& type = metadata.socket_type;
  return metadata.is_valid && (type == "DEALER" || type == "ROUTER");
}

std::string metadata_of(std::string_view socket_type) {
  std::string data;
  append_property(data, "Socket-Type", socket_type);
  append_property(data, "Identity", "");
  return data;
}

std::optional<Bytes> ping_context(Bytes body) {
  constexpr std::size_t time_to_live = 2, longest_context = 16;  // [bytes]
  const auto ping = command_data(body, "PING");
  if (!ping || ping->size() < time_to_live) return std::nullopt;
  return ping->subspan(time_to_live, std::min(longest_context, ping->size() - time_to_live));
}

}  // namespace ziggurat::zmtp
