// SPDX-License-Identifier: MIT
#include "run/awaited_notice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "run/absent.h"
#include "text/hosts.h"

namespace ziggurat::run {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds noticeable{500};  // a wait that the progress line names
constexpr milliseconds long_wait{5000};  // a wait that gets a line of its own

/// Whether a place names a line, `FILE:LINE`.
bool has_line(const std::string& place) {
  const auto colon = place.rfind(':');
  return colon != std::string::npos &&
         place.find_first_not_of("0123456789", colon + 1) == std::string::npos;
}

/// "director 'judge'", for each that the tick waits for.
std::vector<std::string> awaited_of(const std::vector<network::DirectorStatus>& directors) {
  std::vector<std::string> names;
  for (const network::DirectorStatus& each : directors) {
    if (each.is_awaited) names.push_back(fmt::format("director '{}'", each.id));
  }
  return names;
}

/// Robots whose answer the tick waits for.
std::vector<std::size_t> awaited_of(const std::vector<network::RobotStatus>& status) {
  std::vector<std::size_t> robots;
  for (std::size_t r = 0; r < status.size(); ++r) {
    const bool is_gone = status[r].membership == network::RobotStatus::Membership::gone;
    if (!is_gone && status[r].awaited) robots.push_back(r);
  }
  return robots;
}

}  // namespace

// "r3: aggregate.lua:41, r7: lift.lua:12"
/// @param robots  awaited; those whose process runs the script of a robot are taken out
/// @param detail  out: of the text
std::string AwaitedNotice::busy_scripts(std::vector<std::size_t>& robots, Detail& detail) const {
  std::string text, last;
  detail = Detail::robots;
  std::erase_if(robots, [&](std::size_t robot) {
    const auto script = controllers_.busy_script(robot);
    if (!script || script->place.empty()) return false;
    if (script->robot == last) return true;  // of the same process
    last = script->robot;
    detail = std::max(detail, has_line(script->place) ? Detail::lines : Detail::scripts);
    text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", script->robot, script->place);
    return true;
  });
  return text;
}

AwaitedNotice::Text AwaitedNotice::text(std::vector<std::size_t> robots,
                                        const std::vector<std::string>& directors) const {
  Text text;
  const auto busy = busy_scripts(robots, text.detail);
  auto rest = by_controller(world_, robots);
  if (!directors.empty()) {
    rest += fmt::format("{}{}", rest.empty() ? "" : ", ", fmt::join(directors, ", "));
  }
  text.line = busy.empty() || rest.empty() ? busy + rest : busy + ", " + rest;
  return text;
}

bool AwaitedNotice::client_must_connect(bool gathered) const {
  return std::ranges::any_of(absent_robots(server_.status(), gathered),
                             [&](std::size_t robot) { return !controllers_.have(robot); }) ||
         std::ranges::any_of(absent_directors(directors_.status(), gathered),
                             [&](const auto& id) { return !controllers_.have_director(id); });
}

void AwaitedNotice::tell(reports::Progress& progress, std::uint64_t tick, bool gathered) {
  const auto waited = clock::now() - since_;
  const auto robots = awaited_of(server_.status());
  const auto directors = awaited_of(directors_.status());
  if (progress.needs_update()) {
    progress.show(tick, waited > noticeable ? text(robots, directors).line : std::string());
  }
  const bool must_connect = client_must_connect(gathered);
  if (!must_connect && waited < long_wait) return;
  auto awaited = by_controller(world_, robots) + fmt::format("{}", fmt::join(directors, ", "));
  const auto [line, detail] = text(robots, directors);
  if (awaited.empty() || (awaited == printed_ && detail <= printed_detail_)) return;
  std::vector<std::string> endpoints = server_.endpoints();
  std::ranges::transform(endpoints, endpoints.begin(), text::endpoint_to_call);
  const auto where =
      must_connect ? fmt::format(" to connect to {}", fmt::join(endpoints, " or ")) : std::string();
  console_.notice(fmt::format("waiting for {}{}", line, where));
  printed_ = std::move(awaited);
  printed_detail_ = detail;
}

}  // namespace ziggurat::run
