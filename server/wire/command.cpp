#include "wire/command.h"

#include <fmt/format.h>

#include "wire/command_driving.h"
#include "wire/command_radios.h"
#include "wire/command_values.h"
#include "wire/fault.h"
#include "wire/positions.h"

namespace ziggurat::wire {

std::optional<Fault> check(const google::protobuf::RepeatedPtrField<v1::LogLine>& log,
                           const Roster& roster) {
  for (const v1::LogLine& line : log) {
    if (line.robot() >= roster.robots.size()) {
      return make_fault(ErrorCode::unknown_robot, "log",
                        fmt::format("The session has {} robots; there is none at position {}.",
                                    roster.robots.size(), line.robot()));
    }
  }
  return std::nullopt;
}

std::optional<Fault> check(const v1::Command& command, const Roster& roster,
                           const world::Layout& layout) {
  if (auto found = check_positions(command.robots(), roster, layout)) return found;
  if (auto found = check_values(command, roster, layout)) return found;
  if (auto found = check_driving(command, roster, layout)) return found;
  if (auto found = check_radio_messages(command, roster, layout)) return found;
  return check(command.log(), roster);
}

void apply(const v1::Command& command, const Roster& roster, world::Commands& commands) {
  apply_values(command, roster, commands);
  apply_driving(command, roster, commands);
  apply_radio_messages(command, roster, commands.radio_messages);
}

void append(const google::protobuf::RepeatedPtrField<v1::LogLine>& log, const Roster& roster,
            std::vector<LogLine>& lines) {
  for (const v1::LogLine& line : log) {
    lines.push_back({roster.robots[line.robot()], line.error(), line.text()});
  }
}

}  // namespace ziggurat::wire
