#pragma once
// All output of the program on a terminal: lines of controllers and results on stdout, messages and
// progress on stderr.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "scene/reader.h"

namespace ziggurat::reports {

/// stdout cannot be written any more, for example because the reader of a pipe has ended.
class ConsoleError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Console {
 public:
  struct Style {
    bool quiet = false;  ///< no notices, no progress
    bool json = false;   ///< messages are JSON objects, one a line; no progress
  };
  explicit Console(Style style);

  Console() : Console(Style{}) {}
  ~Console() { erase_progress(); }

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

  /// Writes all lines that are still in memory. @throws ConsoleError
  void flush();

 private:
  void append(std::string_view line);
  void message(std::string_view severity, std::string_view text);
  void to_stderr(std::string_view line);
  void erase_progress();

  Style style_;
  bool color_out_, color_error_, shows_progress_;
  bool progress_shown_ = false;
  std::string out_;  ///< not yet written to stdout
};

}  // namespace ziggurat::reports
