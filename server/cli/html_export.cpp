// SPDX-License-Identifier: MIT
#include "cli/html_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "cli/atomic_file.h"
#include "recording/mcap/repair.h"
#include "text/quoting.h"

namespace ziggurat::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view place = "<!--@RECORDING@-->";
/// Browsers hold all of a page in memory.
constexpr std::size_t largest = std::size_t{350} << 20;
/// The recording is cut into parts of that size [bytes], a multiple of three.
constexpr std::size_t part_size = std::size_t{768} << 10;
/// For repeating the run, and for other viewers: the page shows the same by /poses.
constexpr std::array<std::string_view, 3> unused{"/state", "/scene", "/tf"};

[[noreturn]] void fail(const std::string& text) { throw std::runtime_error(text); }

std::ifstream open(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(fmt::format("{} can't be read: {}", path, std::strerror(errno)));
  return file;
}

/// The page around the recording.
struct Template {
  std::string begin, rest;
};

Template read_template(const std::string& player) {
  if (!fs::exists(player)) {
    fail(fmt::format(
        "the page was not built: there is no {}; install nodejs and npm, and build again", player));
  }
  std::ifstream file = open(player);
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  const auto found = all.find(place);
  if (found == std::string::npos) {
    fail(fmt::format("{} has no place for a recording; build the page again", player));
  }
  return {all.substr(0, found), all.substr(found + place.size())};
}

/// Messages that the page shows, as an MCAP file.
std::string shown_of(const std::string& name, const mcap::Reader& recording) {
  std::string bytes;
  const auto keep = [&](std::string_view more) {
    if (bytes.size() + more.size() > largest) {
      fail(
          fmt::format("{} is too large: a page holds at most {} MB; record fewer topics "
                      "(--record-topics), or drop the file on the page of --view",
                      name, largest / 1'000'000));
    }
    bytes += more;
  };
  const auto is_shown = [](const std::string& topic) {
    return std::ranges::find(unused, topic) == unused.end();
  };
  mcap::repair(recording, keep, mcap::Compression::zstd,
               {.topics = is_shown, .messages_alone = true});
  return bytes;
}

/// @return  what was written [bytes]
std::uint64_t write_page(const Template& page, const std::string& name, std::string_view recording,
                         std::ostream& to) {
  std::uint64_t size = 0;
  const auto write = [&](const std::string& text) {
    to << text;
    size += text.size();
  };
  write(page.begin);
  write(
      fmt::format("<template id=\"recording\" data-name=\"{}\" data-size=\"{}\" data-part=\"{}\">"
                  "</template>\n",
                  text::html_text(name), recording.size(), part_size));
  for (std::size_t at = 0, number = 0; at < recording.size(); at += part_size, ++number) {
    write(fmt::format("<script type=\"application/octet-stream\" id=\"part{}\">{}</script>\n",
                      number, to_base64(recording.substr(at, part_size))));
  }
  write(page.rest);
  return size;
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

std::uint64_t export_html(const std::string& player, const std::string& name,
                          const mcap::Reader& recording, const std::string& out) {
  const Template page = read_template(player);
  const std::string bytes = shown_of(name, recording);
  if (out == "-") {
    const std::uint64_t size = write_page(page, name, bytes, std::cout);
    if (!std::cout.flush()) fail(fmt::format("stdout can't be written: {}", std::strerror(errno)));
    return size;
  }
  AtomicFile whole(out);
  std::ofstream file(whole.path(), std::ios::binary | std::ios::trunc);
  const std::uint64_t size = write_page(page, name, bytes, file);
  file.close();
  if (!file) fail(fmt::format("{} can't be written: {}", out, std::strerror(errno)));
  whole.commit();
  return size;
}

}  // namespace ziggurat::cli
