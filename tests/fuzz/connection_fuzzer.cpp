// SPDX-License-Identifier: MIT
// A connection's bytes before they are messages: ZMTP's greeting, handshake and frames, in pieces
// of any size, and a request to the metrics port. What is taken must lie within what has arrived,
// and cutting the bytes otherwise must give the same messages.

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "http/port.h"
#include "network/zmtp/engine.h"
#include "require.h"

namespace {

using namespace ziggurat;
using fuzz::require;
using network::zmtp::Engine;
using network::zmtp::Taken;
using Step = Taken::Step;

constexpr std::size_t limit = 1000;

struct Outcome {
  std::vector<std::string> frames;
  std::string replies;
  bool has_failed = false;
  bool operator==(const Outcome&) const = default;
};

const network::zmtp::CurveKeys& keys() {
  static const network::zmtp::CurveKeys keys(
      {"JTKVSB%%)wK0E.X)V>+}o?pNmC{O&4W4b!Ni{Lh6",
       {{"rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7", {.controller = true}, ""}}});
  return keys;
}

/// @param piece  bytes that arrive at a time
Outcome play(bool is_curve, const std::string& bytes, std::size_t piece) {
  Engine engine(is_curve ? &keys() : nullptr);
  Outcome outcome;
  std::vector<std::uint8_t> input;
  std::size_t begin = 0, to_skip = 0;
  for (std::size_t at = 0; at < bytes.size() && !outcome.has_failed; at += piece) {
    input.insert(input.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at + piece, bytes.size())));
    for (;;) {
      const std::size_t skipped = std::min(to_skip, input.size() - begin);
      begin += skipped;
      to_skip -= skipped;
      if (to_skip > 0) break;
      const std::span front(input.data() + begin, input.size() - begin);
      const Taken taken = engine.take(front, limit, outcome.replies);
      outcome.has_failed = taken.step == Step::failed;
      if (outcome.has_failed) break;
      if (taken.step == Step::incomplete) {
        require(taken.size > front.size());
        break;
      }
      if (taken.step == Step::too_long) {
        require(taken.size > limit && engine.is_open());
        to_skip = taken.size;
        continue;
      }
      require(taken.size > 0 && taken.size <= front.size());
      begin += taken.size;
      if (taken.step != Step::frame) continue;
      require(engine.is_open() && taken.content.size() <= limit);
      outcome.frames.emplace_back(network::zmtp::text_of(taken.content));
    }
  }
  return outcome;
}

void ask(const std::string& request) {
  const auto read = [](std::string_view path) {
    return http::Answer{path == "/" ? 200u : 404u, "text/plain", {}, "text"};
  };
  const std::string answer = http::answer_at_port(request, "localhost", read);
  require(answer.starts_with("HTTP/1.1 "));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::string text(reinterpret_cast<const char*>(data + 2), size - 2);
  if (data[0] % 4 == 0) {
    ask(text);
    return 0;
  }
  std::string bytes;
  const bool is_curve = data[0] % 4 == 1;
  if (data[0] % 4 == 2) {  // a client that has said who it is
    bytes = Engine(nullptr).greeting();
    network::zmtp::append_command(bytes, "READY", network::zmtp::metadata_of("DEALER"));
  } else if (data[0] % 4 == 3 || is_curve) {
    bytes = Engine(is_curve ? &keys() : nullptr).greeting().substr(0, data[1] % 65);
  }
  bytes += text;
  const Outcome whole = play(is_curve, bytes, bytes.size() + 1);
  if (!is_curve) require(play(is_curve, bytes, 1 + data[1] % 16) == whole);
  return 0;
}
