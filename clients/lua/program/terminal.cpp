// SPDX-License-Identifier: MIT
#include "program/terminal.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "program/signals.h"
#include "text/buffered_stream.h"
#include "text/printable.h"

namespace ziggurat::lua {
namespace {

/// A stream of C with a buffer.
struct Stream {
  explicit Stream(int descriptor) : buffer(descriptor) {}

  text::BufferedStream buffer;
  bool is_printable = true;
  std::string rest;  // bytes of a character of which more is to come
};

/// Number of bytes at the end that begin an unfinished character of UTF-8.
std::size_t unfinished_bytes(std::string_view text) {
  for (std::size_t back = 1; back <= std::min<std::size_t>(3, text.size()); ++back) {
    const auto byte = static_cast<unsigned char>(text[text.size() - back]);
    if ((byte & 0xC0U) == 0x80U) continue;
    const std::size_t length = byte >= 0xF0 ? 4 : byte >= 0xE0 ? 3 : byte >= 0xC2 ? 2 : 1;
    return length > back ? back : 0;
  }
  return 0;
}

ssize_t write(void* cookie, const char* bytes, std::size_t size) {
  auto& stream = *static_cast<Stream*>(cookie);
  if (stream.is_printable) {
    std::string text = stream.rest + std::string(bytes, size);
    const std::size_t whole = text.size() - unfinished_bytes(text);
    stream.rest = text.substr(whole);
    stream.buffer.add(text::printable(std::string_view(text).substr(0, whole)));
  } else {
    stream.buffer.add({bytes, size});
  }
  stream.buffer.write();  // a reader that is gone is no error of a script
  return static_cast<ssize_t>(size);
}

Stream& out() {
  static Stream& stream = *new Stream(STDOUT_FILENO);  // C writes to it until the process ends
  return stream;
}
Stream& error() {
  static Stream& stream = *new Stream(STDERR_FILENO);
  return stream;
}

std::FILE* open(Stream& stream, int buffering) {
  std::FILE* const file = ::fopencookie(&stream, "w", {nullptr, write, nullptr, nullptr});
  if (file != nullptr) std::setvbuf(file, nullptr, buffering, BUFSIZ);
  return file;
}

/// Until all is written or a signal asks the program to end.
void finish(text::BufferedStream& buffer) {
  constexpr std::chrono::milliseconds slice{100};
  while (arrived_signal() == 0 && !buffer.is_empty() && buffer.finish(slice) == 0) {
  }
}

}  // namespace

void take_terminal(bool is_printable) {
  out().is_printable = error().is_printable = is_printable;
  if (std::FILE* const file = open(out(), _IOLBF)) stdout = file;
  if (std::FILE* const file = open(error(), _IONBF)) stderr = file;
}

void offer_to_terminal() {
  for (const auto& [file, stream] : {std::pair{stdout, &out()}, {stderr, &error()}}) {
    ::flockfile(file);  // other threads may print meanwhile
    stream->buffer.write();
    ::funlockfile(file);
  }
}

void finish_terminal() {
  std::fflush(stdout);
  std::fflush(stderr);
  finish(out().buffer);
  if (const auto lost = out().buffer.take_dropped(); lost > 0) {
    std::fprintf(stderr, "ziggurat-lua: %llu texts are missing in stdout, which was not read\n",
                 static_cast<unsigned long long>(lost));
    std::fflush(stderr);
  }
  finish(error().buffer);
}

}  // namespace ziggurat::lua
