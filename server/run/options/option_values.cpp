// SPDX-License-Identifier: MIT
#include "run/options/option_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include "run/options/option_table.h"
#include "scene/settings.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

constexpr std::uint64_t most = std::uint64_t{1} << 20;
constexpr double longest_lease = 4e6;  // [s]
// Simulated seconds per second of wall time. At the least a tick of 0.1 s takes a day.
constexpr double least_factor = 1e-6, most_factor = 1e6;

template <class T>
T read(const char* option, const std::string& text, scene::Value<T> (*read)(std::string_view)) {
  auto value = read(text);
  if (const auto* wrong = std::get_if<scene::Wrong>(&value)) {
    throw text::UsageError(fmt::format("{} {} {}", option, scene::in_quotes(text), wrong->text));
  }
  return std::get<0>(std::move(value));
}

/// Adds an argument for ziggurat-lua.
void add_limit(Options& options, const char* option, const char* passed, const std::string& value) {
  const auto number = text::to_integer(option, value);
  if (number == 0 || number > most) {
    throw text::UsageError(fmt::format("{} is {}; it must be from 1 to {}", option, number, most));
  }
  options.lua_arguments.insert(options.lua_arguments.end(), {passed, std::to_string(number)});
}

}  // namespace

void check_time(const char* option, double seconds) {
  constexpr double longest = 9e9;  // [s], as in scenes: nanoseconds fit 64 bits
  if (seconds > longest) {
    throw text::UsageError(fmt::format("{} is {:g} s; write at most {:g} simulated seconds", option,
                                       seconds, longest));
  }
}

void read_ticks(Options& options, const std::string& value) {
  constexpr std::uint64_t most_ticks = std::uint64_t{1} << 53;  // as in scenes
  options.ticks = text::to_integer("--ticks", value);
  if (*options.ticks > most_ticks) {
    throw text::UsageError(
        fmt::format("--ticks is {}; write at most 2^53, which is {}", value, most_ticks));
  }
}

void read_duration(Options& options, const std::string& value) {
  options.duration = text::to_number("--duration", value);
  if (*options.duration < 0) {
    throw text::UsageError("--duration is negative; write seconds, or 0 for until Ctrl-C");
  }
  check_time("--duration", *options.duration);
}

void read_seed(Options& options, const std::string& value) {
  options.seed = text::to_integer("--seed", value);
}

void read_real_time(Options& options, const std::string& value) {
  const auto number = text::to_number("--real-time", value);
  if (!(number >= least_factor && number <= most_factor)) {
    throw text::UsageError(fmt::format("--real-time is {}; it must be {:g} to {:g}, 1 is real time",
                                       value, least_factor, most_factor));
  }
  options.real_time = number;
}

void read_clock(Options& options, const std::string& value) {
  if (value != "nominal" && value != "beta50") {
    throw text::UsageError(fmt::format("--clock is '{}'; write nominal or beta50", value));
  }
  options.scene_file.clock = value == "nominal" ? scene::Clock::nominal : scene::Clock::beta50;
}

void add_setting(Options& options, const std::string& value) {
  options.scene_file.variation.settings.push_back(read("--set", value, scene::to_setting));
}

void add_parameter(Options& options, const std::string& value) {
  options.scene_file.variation.parameters.push_back(read("--param", value, scene::to_parameter));
}

void set_lenient(Options& options, const std::string&) { options.scene_file.lenient = true; }

void read_scene_size(Options& options, const std::string& value) {
  options.scene_file.max_size = text::to_size("--max-scene-size", value);
}

void add_controller(Options& options, const std::string& value) {
  const auto equals = value.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == value.size()) {
    throw text::UsageError(fmt::format("--controller is '{}'; write ID=COMMAND", value));
  }
  options.controllers.emplace_back(value.substr(0, equals), value.substr(equals + 1));
}

void add_restart(Options& options, const std::string& value) {
  options.restarts.push_back(to_restart(value));
}

void add_deadline(Options& options, const std::string& value) {
  options.deadlines.push_back(to_deadline(value));
}

void add_injection(Options& options, const std::string& value) {
  options.injections.push_back(to_injection(value));
}

void read_lease(Options& options, const std::string& value) {
  options.lease = text::to_number("--lease", value);
  if (options.lease < 0 || options.lease > longest_lease) {
    throw text::UsageError(
        fmt::format("--lease is '{}'; it must be 0 to {} seconds", value, longest_lease));
  }
}

void read_lua_processes(Options& options, const std::string& value) {
  options.lua_processes =
      static_cast<unsigned>(std::min(text::to_integer("--lua-processes", value), most));
}

void read_threads(Options& options, const std::string& value) {
  constexpr std::uint64_t most_threads = 256;
  const std::uint64_t threads = text::to_integer("--threads", value);
  if (threads == 0 || threads > most_threads) {
    throw text::UsageError(
        fmt::format("--threads is {}; it must be from 1 to {}", threads, most_threads));
  }
  options.threads = static_cast<unsigned>(threads);
}

void trust_scripts(Options& options, const std::string&) {
  options.lua_arguments.emplace_back("--trust-scripts");
}

void read_lua_memory(Options& options, const std::string& value) {
  add_limit(options, "--lua-memory", "--max-memory", value);
}

void read_lua_instructions(Options& options, const std::string& value) {
  add_limit(options, "--lua-instructions", "--max-instructions", value);
}

void read_lua_time(Options& options, const std::string& value) {
  add_limit(options, "--lua-time", "--max-time", value);
}

void read_view(Options& options, const std::string& value) { options.view = value; }

void read_record_every(Options& options, const std::string& value) {
  options.record_every = text::to_integer("--record-every", value);
  if (options.record_every == 0) throw text::UsageError("--record-every is 0; write 1 or more");
}

void read_compression(Options& options, const std::string& value) {
  using mcap::Compression;
  for (const auto& [name, compression] :
       {std::pair{"zstd", Compression::zstd}, std::pair{"lz4", Compression::lz4},
        std::pair{"none", Compression::none}}) {
    if (value != name) continue;
    options.record_compression = compression;
    return;
  }
  throw text::UsageError(
      fmt::format("--record-compression is '{}'; write zstd, lz4 or none", value));
}

void read_gate(Options& options, const std::string& value) {
  options.gate = reports::parse_gate(value);
}

void read_warm_up(Options& options, const std::string& value) {
  options.warm_up = text::to_integer("--warm-up", value);
}

}  // namespace ziggurat::run
