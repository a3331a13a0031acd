// SPDX-License-Identifier: MIT
#include "reports/console.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "reports/json_text.h"
#include "text/printable.h"

namespace ziggurat::reports {
namespace {

constexpr std::string_view dim = "\033[2m", red = "\033[31m", plain = "\033[0m";
constexpr std::string_view erase_line = "\r\033[K";
constexpr std::string_view clear_screen = "\033[H\033[2J";

std::size_t terminal_width() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

Console::Console(Style style)
    : style_(style),
      color_out_(::isatty(STDOUT_FILENO)),
      color_error_(::isatty(STDERR_FILENO) && !style.json),
      shows_progress_(::isatty(STDERR_FILENO) && !style.quiet && !style.json),
      out_(STDOUT_FILENO),
      error_(STDERR_FILENO) {}

Console::~Console() {
  erase_progress();
  out_.finish();
  error_.finish();
}

void Console::log_line(std::uint64_t tick, std::string_view robot, std::string_view text,
                       bool error) {
  if (style_.mutes_controllers) return;
  const bool color = error ? color_error_ : color_out_;
  const auto begin = color ? (error ? red : dim) : std::string_view();
  const auto end = color ? plain : std::string_view();
  do {
    const auto line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const auto written = fmt::format("{}[{} {}]{} {}", begin, tick, text::printable(robot), end,
                                     text::printable(line));
    if (error) {
      to_stderr(written);
    } else {
      out_.add(written + '\n');
    }
  } while (!text.empty());
}

void Console::result(std::string_view line) { out_.add_always(text::printable(line) + '\n'); }

void Console::redraw(std::string_view text) {
  out_.add_always(clear_screen);
  result(text);
}

void Console::fault(std::string_view text) { message("fault", text); }

void Console::warning(std::string_view text) {
  if (!style_.quiet) message("warning", text);
}

void Console::notice(std::string_view text) {
  if (!style_.quiet) message("notice", text);
}

void Console::message(std::string_view severity, std::string_view text) {
  const bool fault = severity == "fault";
  if (style_.json)
    return to_stderr(text::printable_json(json_text({{"severity", severity}, {"text", text}})),
                     fault);
  to_stderr(fmt::format("{}ziggurat: {}{}{}", color_error_ && fault ? red : "",
                        fault ? "" : fmt::format("{}: ", severity), text::printable(text),
                        color_error_ && fault ? plain : ""),
            fault);
}

void Console::problem(const scene::Problem& problem) {
  const bool fault = problem.severity == scene::Problem::Severity::fault;
  if (!fault && style_.quiet) return;
  if (style_.json) {
    return to_stderr(text::printable_json(json_text({{"severity", scene::to_text(problem.severity)},
                                                     {"file", problem.file},
                                                     {"line", problem.where.line},
                                                     {"column", problem.where.column},
                                                     {"text", scene::text_of(problem)}})));
  }
  const std::string kind = fault ? "" : fmt::format("{}: ", scene::to_text(problem.severity));
  to_stderr(text::printable(kind + to_string(problem)));
}

void Console::report(std::string_view text) {
  if (!style_.quiet) to_stderr(text::printable(text));
}

void Console::progress(std::string_view text) {
  if (!shows_progress_) return;
  offer();
  if (!error_.is_empty()) return;  // the terminal stands still
  error_.add(
      fmt::format("{}{}", erase_line, text::printable(text.substr(0, terminal_width() - 1))));
  error_.write();
  progress_shown_ = true;
}

void Console::check(int error) {
  if (error == 0) return;
  throw ConsoleError(fmt::format("stdout cannot be written: {}", std::strerror(error)));
}

void Console::tell_dropped() {
  if (!out_.is_empty()) return;
  if (const auto lines = out_.take_dropped(); lines > 0) {
    message(
        "notice",
        fmt::format("{} lines of controllers are missing in stdout, which was not read", lines));
  }
}

void Console::offer() {
  if (!out_.is_empty()) erase_progress();
  check(out_.write());
  tell_dropped();
  error_.write();  // for what can't be written there, there is no other place
}

void Console::flush() {
  if (!out_.is_empty()) erase_progress();
  check(out_.finish());
  tell_dropped();
  error_.finish();
}

// Both streams often end in one place: what was said first stands first.
void Console::to_stderr(std::string_view line, bool must_stay) {
  check(out_.write());
  erase_progress();
  const std::string whole = fmt::format("{}\n", line);
  must_stay ? error_.add_always(whole) : error_.add(whole);
  error_.write();
}

void Console::erase_progress() {
  if (std::exchange(progress_shown_, false)) error_.add_always(erase_line);
  error_.write();
}

}  // namespace ziggurat::reports
