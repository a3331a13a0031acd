#include "reports/console.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "text/printable.h"

namespace ziggurat::reports {
namespace {

constexpr std::string_view dim = "\033[2m", red = "\033[31m", plain = "\033[0m";
constexpr std::string_view erase_line = "\r\033[K";
constexpr std::string_view clear_screen = "\033[H\033[2J";

void write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && descriptor == STDERR_FILENO) return;  // there is no other place for a message
    if (count < 0) {
      throw ConsoleError(fmt::format("stdout cannot be written: {}", std::strerror(errno)));
    }
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

std::size_t terminal_width() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

// JSON text, also if a text of a peer is not UTF-8.
std::string dump(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

Console::Console(Style style)
    : style_(style),
      color_out_(::isatty(STDOUT_FILENO)),
      color_error_(::isatty(STDERR_FILENO) && !style.json),
      shows_progress_(::isatty(STDERR_FILENO) && !style.quiet && !style.json) {}

void Console::log_line(std::uint64_t tick, std::string_view robot, std::string_view text,
                       bool error) {
  const bool color = error ? color_error_ : color_out_;
  const auto begin = color ? (error ? red : dim) : std::string_view();
  const auto end = color ? plain : std::string_view();
  do {
    const auto line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const auto written = fmt::format("{}[{} {}]{} {}", begin, tick, text::printable(robot), end,
                                     text::printable(line));
    error ? to_stderr(written) : append(written);
  } while (!text.empty());
}

void Console::result(std::string_view line) { append(text::printable(line)); }

void Console::redraw(std::string_view text) {
  out_ += clear_screen;
  result(text);
}

void Console::append(std::string_view line) {
  out_.append(line);
  out_ += '\n';
}

void Console::fault(std::string_view text) { message("fault", text); }

void Console::warning(std::string_view text) {
  if (!style_.quiet) message("warning", text);
}

void Console::notice(std::string_view text) {
  if (!style_.quiet) message("notice", text);
}

void Console::message(std::string_view severity, std::string_view text) {
  if (style_.json) return to_stderr(dump({{"severity", severity}, {"text", text}}));
  const bool fault = severity == "fault";
  to_stderr(fmt::format("{}ziggurat: {}{}{}", color_error_ && fault ? red : "",
                        fault ? "" : fmt::format("{}: ", severity), text::printable(text),
                        color_error_ && fault ? plain : ""));
}

void Console::problem(const scene::Problem& problem) {
  const bool fault = problem.severity == scene::Problem::Severity::fault;
  if (!fault && style_.quiet) return;
  if (style_.json) {
    return to_stderr(dump({{"severity", scene::to_text(problem.severity)},
                           {"file", problem.file},
                           {"line", problem.where.line},
                           {"column", problem.where.column},
                           {"text", problem.text}}));
  }
  const std::string kind = fault ? "" : fmt::format("{}: ", scene::to_text(problem.severity));
  to_stderr(text::printable(kind + to_string(problem)));
}

void Console::report(std::string_view text) {
  if (!style_.quiet) to_stderr(text::printable(text));
}

void Console::progress(std::string_view text) {
  if (!shows_progress_) return;
  flush();
  write_all(STDERR_FILENO,
            fmt::format("{}{}", erase_line, text::printable(text.substr(0, terminal_width() - 1))));
  progress_shown_ = true;
}

void Console::flush() {
  if (out_.empty()) return;
  erase_progress();
  const auto text = std::exchange(out_, {});
  write_all(STDOUT_FILENO, text);
}

// Both streams often end in one place: what was said first stands first.
void Console::to_stderr(std::string_view line) {
  flush();
  erase_progress();
  write_all(STDERR_FILENO, fmt::format("{}\n", line));
}

void Console::erase_progress() {
  if (progress_shown_) write_all(STDERR_FILENO, erase_line);
  progress_shown_ = false;
}

}  // namespace ziggurat::reports
