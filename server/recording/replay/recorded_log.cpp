// SPDX-License-Identifier: MIT
#include "recording/replay/recorded_log.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string_view>

#include "foxglove/schemas.pb.h"

namespace ziggurat::replay {

std::vector<std::string> causes_of_commands(const RecordingFile& file) {
  struct Cause {
    std::string_view sign, text;
    std::uint64_t lines = 0;
    std::string first = {};
  };
  std::array causes{
      Cause{"; started again (restart ", "a controller was restarted then, and lost its memory"},
      Cause{" missed its deadline of ",
            "a deadline was missed then, and other commands took effect"},
      Cause{"missed in a row, ", "a deadline took robots out then"}};
  auto messages = file.messages({"/log"});
  foxglove::Log line;
  while (messages) {
    const auto message = next(file, *messages);
    if (!message) break;
    file.decode(*messages, *message, line);
    if (line.name() != "ziggurat") continue;
    for (Cause& cause : causes) {
      if (line.message().find(cause.sign) == std::string::npos) continue;
      if (cause.lines++ == 0) cause.first = line.message();
    }
  }
  std::vector<std::string> sentences;
  for (const Cause& cause : causes) {
    if (cause.lines == 0) continue;
    sentences.push_back(fmt::format(
        "likely cause: {}: {}{}", cause.text, cause.first,
        cause.lines > 1 ? fmt::format(" (and {} more)", cause.lines - 1) : std::string()));
  }
  return sentences;
}

}  // namespace ziggurat::replay
