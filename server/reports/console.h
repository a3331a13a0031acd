// SPDX-License-Identifier: MIT
#pragma once
// All output of the program on a terminal: lines of controllers and results on stdout, messages and
// progress on stderr.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "scene/reader.h"
#include "text/buffered_stream.h"

namespace ziggurat::reports {

/// stdout cannot be written any more, for example because the reader of a pipe has ended.
class ConsoleError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Console {
 public:
  struct Style {
    bool quiet = false;              ///< no notices, no progress
    bool json = false;               ///< messages are JSON objects, one a line; no progress
    bool mutes_controllers = false;  ///< no lines that controllers log
  };
  explicit Console(Style style);

  Console() : Console(Style{}) {}
  /// Waits for the readers of what was not written yet.
  ~Console();

  /// A line that a controller logged: `[<tick> <robot>] <text>`, on stdout, an error on stderr.
  /// A text of several lines becomes several such lines.
  void log_line(std::uint64_t tick, std::string_view robot, std::string_view text, bool error);

  /// A line of the result, on stdout.
  void result(std::string_view line);

  /// The same in place of all that is on the terminal.
  void redraw(std::string_view text);

  /// A message on stderr: the program or a controller ends.
  void fault(std::string_view text);
  /// A message on stderr: something is probably not what was meant.
  void warning(std::string_view text);
  /// A message on stderr that the user should know.
  void notice(std::string_view text);
  void problem(const scene::Problem& problem);
  /// Text of several lines on stderr, unless quiet.
  void report(std::string_view text);

  /// The line that is overwritten by the next one; only on a terminal, cut to its width.
  void progress(std::string_view text);
  bool shows_progress() const { return shows_progress_; }

  /// Writes the lines that are still in memory as far as their readers take them now: a reader that
  /// stops does not stop the caller. Beyond 16 MiB lines of controllers are dropped, which a notice
  /// counts.
  /// @throws ConsoleError
  void offer();
  /// Waits until all lines are written. @throws ConsoleError
  void flush();

 private:
  void check(int error);
  void tell_dropped();
  void message(std::string_view severity, std::string_view text);
  void to_stderr(std::string_view line, bool must_stay = false);
  void erase_progress();

  Style style_;
  bool color_out_, color_error_, shows_progress_;
  bool progress_shown_ = false;
  text::BufferedStream out_, error_;
};

}  // namespace ziggurat::reports
