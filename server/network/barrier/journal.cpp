// SPDX-License-Identifier: MIT
#include "network/barrier/journal.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace ziggurat::network {
namespace {

constexpr std::size_t max_notice = 1000;    // bytes
constexpr std::size_t max_failure = 16384;  // bytes of a failure's message

std::string line_of(std::string_view text) {
  std::string line(text.substr(0, max_notice));
  while (line.ends_with('\n')) line.pop_back();
  std::ranges::replace(line, '\n', ' ');
  return printable(line);
}

}  // namespace

std::string printable(std::string_view text) {
  std::string result(text);
  for (char& character : result) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte < 0x20 || byte == 0x7F) character = '?';
  }
  return result;
}

void Journal::note(std::string_view text, Time now) { notices_.add(line_of(text), now); }

void Journal::note_other(std::string_view text, Time now) { of_others_.add(line_of(text), now); }

void Journal::fail(std::size_t robot, std::string_view message, std::uint64_t tick) {
  report_.failures.push_back({robot, std::string(message.substr(0, max_failure)), tick});
}

void Journal::fail(std::string director, std::string_view message, std::uint64_t tick) {
  report_.failed_directors.push_back(
      {std::move(director), std::string(message.substr(0, max_failure)), tick});
}

void Journal::stop(std::string text) {
  if (report_.stopped.empty()) report_.stopped = std::move(text);
}

void Journal::shrink(std::size_t count) {
  const auto is_behind = [&](const auto& entry) { return entry.robot >= count; };
  std::erase_if(report_.log, is_behind);
  std::erase_if(report_.failures, is_behind);
  std::erase_if(report_.departures, is_behind);
}

Report Journal::take() {
  const auto by_robot = [](const auto& a, const auto& b) { return a.robot < b.robot; };
  std::stable_sort(report_.log.begin(), report_.log.end(), by_robot);
  std::stable_sort(report_.failures.begin(), report_.failures.end(), by_robot);
  std::stable_sort(report_.departures.begin(), report_.departures.end(), by_robot);
  report_.notices = notices_.take();
  std::ranges::move(of_others_.take(), std::back_inserter(report_.notices));
  return std::exchange(report_, {});
}

Report Journal::take(Time now) {
  notices_.tell_last(now);
  of_others_.tell_last(now);
  return take();
}

}  // namespace ziggurat::network
