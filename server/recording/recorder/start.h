// SPDX-License-Identifier: MIT
#pragma once
// Start of a recording: the properties of its run as a whole.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ziggurat/v1/run.pb.h"

namespace ziggurat::recorder {

/// A file that is embedded in the recording.
struct EmbeddedFile {
  std::string name;  ///< the path as it was asked for
  std::string text;
};

/// Build of the program, as far as it may change the bits of a run.
struct Build {
  std::string version, compiler, options, libm, cpu_path;
};

/// As in the message RunStart (run.proto), which explains the fields.
struct Start {
  struct Controller {
    std::string id, command, script;
  };
  std::string scene, scene_hash;
  std::uint64_t seed = 1;
  bool lenient = false;
  std::vector<std::pair<std::string, std::string>> settings, parameters;
  std::string clock;
  std::uint64_t last_tick = 0;
  std::vector<Controller> controllers;
  std::vector<std::size_t> robots_without_controller;
  std::string date;
  Build build;
  std::vector<std::string> arguments;
  std::vector<EmbeddedFile> files;  ///< attachments
  std::string snapshot;  ///< that the world begins with: of the file `snapshot/…`; empty: none
};

v1::RunStart to_message(const Start& start);

}  // namespace ziggurat::recorder
