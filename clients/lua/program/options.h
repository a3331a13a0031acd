// SPDX-License-Identifier: MIT
#pragma once
// The command line of ziggurat-lua.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "script/folders.h"

namespace ziggurat::lua {

struct ProgramOptions {
  std::string endpoint;
  std::vector<std::string> robots;  ///< ids or globs, with those of --robots-file
  bool has_list = false;            ///< of --robots-file: some may have left since it was written
  std::string robots_from;          ///< pipe with ids of robots that come later; empty: none
  std::string controller;           ///< id in the scene; empty for all
  std::optional<std::string> director;          ///< runs this director of the scene, and no robots
  std::optional<std::filesystem::path> script;  ///< instead of the scene's
  std::string server_key, curve_secret;         ///< as in ziggurat::Options
  std::string session_token;                    ///< the same; empty with robots_from
  std::string name = "ziggurat-lua";
  /// Scripts that the server names must be below these, and so must the files that scripts use;
  /// never empty.
  std::vector<std::filesystem::path> folders{"."};
  bool names_any_ending = false;  ///< the server may name scripts there that do not end with .lua
  Exceptions exceptions;          ///< files there that scripts may use less
  bool trusts_scripts = false;    ///< all of Lua, all files
  std::size_t max_memory = std::size_t{256} << 20;  ///< per robot [bytes]
  std::uint64_t max_instructions = 1'000'000'000;   ///< per robot and call; 0 = any number
  std::uint64_t max_computing = 20;  ///< processor time per robot and call [s]; 0 = any
  std::string place_file;            ///< as of open_place_file(); empty: none
  bool echo = false;                 ///< print log lines here too
  bool quiet = false;
};

/// Request of the arguments: a run, or only a text.
struct Request {
  ProgramOptions options;
  std::string text;  ///< of --help or --version; empty otherwise
};

/// Reads the arguments, and ZIGGURAT_ENDPOINT, ZIGGURAT_CONTROLLER, ZIGGURAT_SERVER_KEY,
/// ZIGGURAT_CURVE_SECRET and ZIGGURAT_SESSION_TOKEN for those that are missing.
/// @param is_terminal  stdout is a terminal: log lines are printed here unless quiet
/// @throws std::runtime_error, naming the wrong argument and the allowed values
Request read_arguments(int count, const char* const* arguments, bool is_terminal);

}  // namespace ziggurat::lua
