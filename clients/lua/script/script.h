// SPDX-License-Identifier: MIT
#pragma once
// A script with its Lua state: its chunk, and calls of its functions.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "script/arena.h"
#include "script/environment.h"
#include "script/folders.h"
#include "script/interrupt.h"
#include "script/log_lines.h"
#include "script/memory.h"
#include "script/open_files.h"

namespace ziggurat::lua {

struct ScriptOptions {
  std::filesystem::path script;
  std::uint64_t seed = 1;                           ///< of the run
  std::uint64_t first_tick = 0;                     ///< at which the script begins
  std::size_t max_memory = std::size_t{256} << 20;  ///< of the script's Lua state [bytes]
  std::uint64_t max_instructions = 1'000'000'000;   ///< of a call (interrupt.h); 0 = any number
  std::uint64_t max_computing = 20;                 ///< processor time of a call [s]; 0 = any
  /// The files that the script may use; they outlive it. Null: the script is trusted, and may use
  /// all of Lua.
  const Folders* folders = nullptr;
  std::size_t most_files =
      most_open_files;     ///< that a script that is not trusted may have open at once
  Arena* arena = nullptr;  ///< for the script's Lua state; outlives it. Null: it has malloc()
  std::uint64_t max_in_library =
      5;  ///< processor time of a function of Lua's library in a call [s]
};

/// The error of a script: `scenes/x.lua:12: attempt to … (in step 37)`, a line feed, and Lua's
/// traceback. Do not call the script again.
using Failure = std::optional<std::string>;

/// Every error of the script is a Failure, never an exception.
class Script {
 public:
  virtual ~Script() = default;
  Script(const Script&) = delete;
  Script& operator=(const Script&) = delete;

  /// Log lines of the script, also of a call that failed. The caller clears them.
  LogLines& log() { return log_; }
  std::size_t used_memory() const { return state_.used_bytes(); }  ///< [bytes]

 protected:
  /// @param name  of its robot or director, unique in the run: for its random streams and for
  /// messages
  /// @throws std::bad_alloc if max_memory does not hold an empty state
  Script(std::string name, const ScriptOptions& options);

  struct Wanted {
    const char* name = nullptr;  // of a function of the script
    bool is_required = false;
    std::optional<std::uint64_t> tick;  // its argument
  };

  /// Sets the globals of this kind of script, and refreshes them before each call. May raise a Lua
  /// error.
  virtual void set_up(lua_State* state) = 0;
  virtual void refresh(lua_State* state) = 0;

  Failure run_chunk();
  bool has(const char* function);
  /// @param answer  becomes what the function returns, if it is there
  Failure call(const Wanted& wanted, const std::string& moment, bool* answer = nullptr);
  Failure call(const char* function, bool is_required, const std::string& moment);
  /// A new run with this seed begins: so do the random streams.
  void begin_anew(std::uint64_t seed) { random_ = RandomStreams(seed, name_); }

  RandomStreams& random() { return random_; }
  const std::string& path() const { return script_; }  ///< for messages
  std::uint64_t first_tick() const { return first_tick_; }
  Calling calling() const {
    return {name_.c_str(),     script_.c_str(), state_.get(),
            max_instructions_, max_computing_,  max_in_library_};
  }

 private:
  static int build(lua_State* state);
  static int load(lua_State* state);
  static int prepare(lua_State* state);
  void keep_small();

  Failure call_prepared(const std::string& moment, int arguments, int results);
  void push_protected(int (*function)(lua_State*));
  std::string describe_error(const std::string& moment);

  LogLines log_;
  RandomStreams random_;
  std::string name_;
  std::uint64_t first_tick_;
  std::size_t max_memory_;
  std::uint64_t max_instructions_;
  std::uint64_t max_computing_;
  std::uint64_t max_in_library_;
  const Folders* folders_;
  std::size_t most_files_;
  std::string script_;         // path for messages
  std::string folder_;         // of the script
  Wanted wanted_;              // by prepare()
  std::size_t calls_ = 0;      // since the last collection by keep_small()
  std::size_t collected_ = 0;  // memory in use after that [bytes]
  BoundedState state_;         // last: its finalizers may use the others
};

}  // namespace ziggurat::lua
