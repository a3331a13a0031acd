// SPDX-License-Identifier: MIT
#pragma once
// Overview of a recording, or of any other MCAP file.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "recording/mcap/reader.h"
#include "recording/mcap/scan.h"
#include "recording/recorder/start.h"

namespace ziggurat::recorder {

struct Overview {
  struct Topic {
    std::string name, type;
    std::uint64_t messages = 0;
    std::uint64_t bytes = 0;  ///< of the messages' data, before compression
  };
  std::optional<Start> start;  ///< without files; nothing: this is no recording of a run
  std::vector<Topic> topics;   ///< sorted by name
  std::uint64_t states = 0;    ///< that were published
  std::uint64_t epochs = 0;    ///< how often the world began
  std::uint64_t last_tick = 0;
  double length = 0;               ///< from the first message to the last, simulated [s]
  std::uint64_t uncompressed = 0;  ///< all chunks [bytes]
};

/// Overview of the intact part.
Overview overview(const mcap::Reader& reader);

/// Start of the recorded run, without files. @throws mcap::Damaged if it can't be read
std::optional<Start> read_start(const mcap::Reader& reader);

}  // namespace ziggurat::recorder
