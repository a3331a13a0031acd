#include "wire/command.h"

#include <fmt/format.h>

#include "wire/devices.h"
#include "wire/fault.h"

namespace ziggurat::wire {
namespace {

/// The robots of a message: positions in the session, of robots that have not left, each once. A
/// client may not know yet which were taken over.
std::optional<Fault> check_positions(const google::protobuf::RepeatedField<std::uint32_t>& robots,
                                     const Roster& roster, const world::Layout& layout) {
  std::vector<bool> named(robots.empty() ? 0 : roster.robots.size(), false);
  for (const std::uint32_t position : robots) {
    if (auto found = check_position(position, roster, "robots")) return found;
    const std::string& id = layout.robots[roster.robots[position]].id;
    if (roster.gone[position] && !roster.taken[position]) {
      return make_fault(ErrorCode::not_yours, "robots",
                        fmt::format("Robot '{}' has left the run; leave it out of `robots`.", id),
                        id);
    }
    if (named[position]) {
      return make_fault(ErrorCode::bad_value, "robots",
                        fmt::format("Robot '{}' (position {}) is named twice.", id, position), id);
    }
    named[position] = true;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::LogLine>& log,
                           const Roster& roster) {
  for (const v1::LogLine& line : log) {
    if (auto found = check_position(line.robot(), roster, "log")) return found;
  }
  return std::nullopt;
}

std::optional<Fault> check(const v1::Command& command, const Roster& roster,
                           const world::Layout& layout) {
  if (auto found = check_positions(command.robots(), roster, layout)) return found;
  if (auto found = check_channels(command, roster, layout)) return found;
  if (auto found = check_radio_messages(command, roster, layout)) return found;
  return check(command.log(), roster);
}

std::optional<Fault> check(const v1::Leave& leave, const Roster& roster,
                           const world::Layout& layout) {
  if (leave.reason() != v1::Leave::DONE && leave.reason() != v1::Leave::FAILED) {
    return make_fault(ErrorCode::bad_value, "reason",
                      "The reason of a Leave must be DONE or FAILED.");
  }
  if (auto found = check_positions(leave.robots(), roster, layout)) return found;
  return check(leave.log(), roster);
}

void apply(const v1::Command& command, const Roster& roster, world::Commands& commands) {
  apply_channels(command, roster, commands);
  apply_radio_messages(command, roster, commands.radio_messages);
}

void append(const google::protobuf::RepeatedPtrField<v1::LogLine>& log, const Roster& roster,
            std::vector<LogLine>& lines) {
  for (const v1::LogLine& line : log) {
    if (roster.taken[line.robot()]) continue;
    lines.push_back({roster.robots[line.robot()], line.error(), line.text()});
  }
}

}  // namespace ziggurat::wire
