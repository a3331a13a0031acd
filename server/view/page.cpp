// SPDX-License-Identifier: MIT
#include "view/page.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "math/hash.h"

namespace ziggurat::view {
namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{64} << 20;  // [bytes]

constexpr std::array types{
    std::pair{".html", "text/html; charset=utf-8"},
    std::pair{".js", "text/javascript; charset=utf-8"},
    std::pair{".mjs", "text/javascript; charset=utf-8"},
    std::pair{".css", "text/css; charset=utf-8"},
    std::pair{".json", "application/json"},
    std::pair{".map", "application/json"},
    std::pair{".svg", "image/svg+xml"},
    std::pair{".png", "image/png"},
    std::pair{".webp", "image/webp"},
    std::pair{".ico", "image/x-icon"},
    std::pair{".woff2", "font/woff2"},
    std::pair{".wasm", "application/wasm"},
    std::pair{".txt", "text/plain; charset=utf-8"},
};

constexpr std::string_view not_built =
    "Ziggurat: the run is there, but its page was not built.\n"
    "Build it with ./quickstart (it needs nodejs and npm), or open the other address that the\n"
    "program printed in Foxglove or Lichtblick.\n";

/// Folders and names of plain characters; nothing that leads out of the folder.
bool is_plain(std::string_view path) {
  constexpr std::string_view characters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_./";
  return path.find_first_not_of(characters) == std::string_view::npos &&
         path.find("..") == std::string_view::npos && path.find("//") == std::string_view::npos &&
         path.find("/.") == std::string_view::npos;
}

std::optional<std::string> read(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  if (std::filesystem::file_size(path, error) > largest_file || error) return std::nullopt;
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

std::string type_of(const std::filesystem::path& path) {
  for (const auto& [ending, type] : types) {
    if (path.extension() == ending) return type;
  }
  return "application/octet-stream";
}

/// Whether the build put a hash of the content into the name: `page-J3BWKQOH.js`.
bool has_hash(const std::filesystem::path& path) {
  constexpr std::size_t letters = 8;
  const std::string name = path.stem().string();
  const auto dash = name.rfind('-');
  return dash != std::string::npos && name.size() - dash - 1 == letters &&
         name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789", dash + 1) ==
             std::string::npos;
}

}  // namespace

http::Answer Page::get(std::string_view target, std::string_view known_etag) const {
  std::string path(target.substr(0, target.find('?')));
  if (path == "/") path = "/index.html";
  if (!path.starts_with('/') || !is_plain(path)) {
    return {404, http::Answer().type, {}, "There is no such file.\n"};
  }
  auto content = read(folder_ + path);
  if (!content && path == "/index.html")
    return {200, http::Answer().type, {}, std::string(not_built)};
  if (!content) return {404, http::Answer().type, {}, "There is no such file.\n"};
  math::Hash hash;
  hash.add(std::string_view(*content));
  // Weak: the same for the body in gzip.
  const std::string etag = "W/\"" + math::to_hex(hash.digest()) + "\"";
  http::Answer answer{200, type_of(path), etag, {}};
  answer.is_immutable = has_hash(path);
  if (etag == known_etag) {
    answer.status = 304;
    return answer;
  }
  answer.gzipped = read(folder_ + path + ".gz").value_or("");
  answer.body = *std::move(content);
  return answer;
}

std::string content_security_policy(std::string_view host) {
  return fmt::format(
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
      "font-src 'self'; worker-src 'self' blob:; connect-src 'self'{}; base-uri 'none'; "
      "form-action 'none'; frame-ancestors 'none'",
      host.empty() ? "" : fmt::format(" ws://{}", host));
}

}  // namespace ziggurat::view
