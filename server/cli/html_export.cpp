#include "cli/html_export.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "cli/atomic_file.h"
#include "text/printable.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic("\x89MCAP0\r\n", 8);
constexpr std::string_view name_place = "@NAME@", recording_place = "@RECORDING@";
/// Browsers hold the text of an element in one string, of at most 512 MiB.
constexpr std::uint64_t largest = std::uint64_t{350} << 20;
constexpr std::size_t block = std::size_t{3} << 20;  ///< a multiple of three: nothing is padded

[[noreturn]] void fail(const std::string& text) { throw std::runtime_error(text); }

std::ifstream open(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(fmt::format("{} can't be read: {}", path, std::strerror(errno)));
  return file;
}

std::string escaped(std::string_view text) {
  std::string all;
  for (const char letter : text::printable(text)) {
    if (std::string_view("&<>\"'").find(letter) == std::string_view::npos) {
      all += letter;
    } else {
      all += fmt::format("&#{};", static_cast<int>(letter));
    }
  }
  return all;
}

/// The page around the recording: up to its name, up to its bytes, and the rest.
struct Template {
  std::string before_name, before_recording, rest;
};

Template read_template(const std::string& player) {
  if (!fs::exists(player)) {
    fail(fmt::format(
        "the page was not built: there is no {}; install nodejs and npm, and build again", player));
  }
  std::ifstream file = open(player);
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  const auto name = all.find(name_place);
  const auto recording = all.find(recording_place);
  if (name == std::string::npos || recording == std::string::npos || recording < name) {
    fail(fmt::format("{} has no place for a recording; build the page again", player));
  }
  const auto after_name = name + name_place.size();
  return {all.substr(0, name), all.substr(after_name, recording - after_name),
          all.substr(recording + recording_place.size())};
}

/// @return what was written [bytes]
std::uint64_t copy_as_base64(std::ifstream& from, std::ostream& to) {
  std::uint64_t size = 0;
  std::string bytes(block, '\0');
  while (from) {
    from.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    const std::string letters = to_base64({bytes.data(), static_cast<std::size_t>(from.gcount())});
    to << letters;
    size += letters.size();
  }
  return size;
}

/// @return what was written [bytes]
std::uint64_t write_page(const Template& page, const std::string& name, std::ifstream& recording,
                         std::ostream& to) {
  const std::string begin = page.before_name + escaped(name) + page.before_recording;
  to << begin;
  const std::uint64_t size = copy_as_base64(recording, to);
  to << page.rest;
  return begin.size() + size + page.rest.size();
}

std::ifstream open_recording(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) fail(fmt::format("{} can't be read: {}", path, error.message()));
  if (size > largest) {
    fail(
        fmt::format("{} has {} MB, and a page holds at most {} MB; record fewer topics "
                    "(--record-topics), or drop "
                    "the file on the page of --view",
                    path, size / 1'000'000, largest / 1'000'000));
  }
  std::ifstream file = open(path);
  std::array<char, magic.size()> begin{};
  file.read(begin.data(), begin.size());
  if (std::string_view(begin.data(), begin.size()) != magic) {
    fail(fmt::format("{} is no recording: it does not begin as an MCAP file does", path));
  }
  file.clear();
  file.seekg(0);
  return file;
}

}  // namespace

std::string to_base64(std::string_view bytes) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? std::uint32_t{static_cast<unsigned char>(bytes[i + k])} : 0;
    };
    const std::uint32_t group = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? letters[(group >> (18 - 6 * k)) & 63] : '=';
    }
  }
  return text;
}

std::uint64_t export_html(const std::string& player, const std::string& recording,
                          const std::string& out) {
  const Template page = read_template(player);
  const std::string name = fs::path(recording).filename().string();
  std::ifstream bytes = open_recording(recording);
  if (out == "-") {
    const std::uint64_t size = write_page(page, name, bytes, std::cout);
    if (!std::cout.flush()) fail(fmt::format("stdout can't be written: {}", std::strerror(errno)));
    return size;
  }
  AtomicFile whole(out);
  std::ofstream file(whole.path(), std::ios::binary | std::ios::trunc);
  const std::uint64_t size = write_page(page, name, bytes, file);
  file.close();
  if (!file || bytes.bad()) fail(fmt::format("{} can't be written: {}", out, std::strerror(errno)));
  whole.commit();
  return size;
}

}  // namespace ziggurat::cli
