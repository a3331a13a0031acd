// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ziggurat/session.h"

namespace ziggurat {
namespace {

constexpr const char* token_name = "ZIGGURAT_SESSION_TOKEN";

unsigned digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10;
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10;
  // The token is a secret: it is not printed.
  throw std::invalid_argument(std::string(token_name) +
                              " is not hexadecimal; it has two digits for each byte of the token");
}

std::string from_hexadecimal(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const char low = i + 1 < text.size() ? text[i + 1] : ' ';
    bytes += static_cast<char>(16 * digit(text[i]) + digit(low));
  }
  return bytes;
}

}  // namespace

void SessionOptions::read_environment() {
  const char* named = std::getenv("ZIGGURAT_ENDPOINT");
  const std::string theirs = named == nullptr ? "" : named;
  const bool is_theirs = endpoint.empty() || endpoint == theirs;
  if (endpoint.empty()) endpoint = theirs.empty() ? find_server() : theirs;
  if (const char* key = std::getenv("ZIGGURAT_SERVER_KEY")) server_key = key;
  if (const char* secret = std::getenv("ZIGGURAT_CURVE_SECRET")) curve_secret = secret;
  if (is_theirs) session_token = take_session_token();
}

Options Options::from_environment() {
  Options options;
  options.read_environment();
  if (const char* controller = std::getenv("ZIGGURAT_CONTROLLER")) options.controller = controller;
  return options;
}

std::string take_session_token() {
  const char* const text = std::getenv(token_name);
  if (text == nullptr) return {};
  const std::string token = from_hexadecimal(text);
  ::unsetenv(token_name);
  return token;
}

}  // namespace ziggurat
