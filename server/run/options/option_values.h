// SPDX-License-Identifier: MIT
#pragma once
// Values of options, from their texts. All throw text::UsageError with what to write instead.

#include <string>

#include "run/options.h"

namespace ziggurat::run {

void read_ticks(Options& options, const std::string& value);
void read_duration(Options& options, const std::string& value);
void read_seed(Options& options, const std::string& value);
void read_real_time(Options& options, const std::string& value);
void read_clock(Options& options, const std::string& value);
void add_setting(Options& options, const std::string& value);
void add_parameter(Options& options, const std::string& value);
void set_lenient(Options& options, const std::string&);
void read_scene_size(Options& options, const std::string& value);
void add_controller(Options& options, const std::string& value);
void add_restart(Options& options, const std::string& value);
void add_deadline(Options& options, const std::string& value);
void add_injection(Options& options, const std::string& value);
void read_lease(Options& options, const std::string& value);
void read_threads(Options& options, const std::string& value);
void read_lua_processes(Options& options, const std::string& value);
void trust_scripts(Options& options, const std::string&);
void read_lua_memory(Options& options, const std::string& value);
void read_lua_instructions(Options& options, const std::string& value);
void read_lua_time(Options& options, const std::string& value);
void read_view(Options& options, const std::string& value);
void read_record_every(Options& options, const std::string& value);
void read_compression(Options& options, const std::string& value);
void read_gate(Options& options, const std::string& value);
void read_warm_up(Options& options, const std::string& value);

}  // namespace ziggurat::run
