// Any bytes are read as a client's message: never a crash, and a command that passes the check
// can be applied without leaving the robots' values or making them other than finite.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "wire/inbox.h"

namespace {

using namespace ziggurat;

void require(bool condition) {
  if (!condition) std::abort();
}

// Three robots with 2, 0 and 3 joint actuators; the session holds the first and the last.
world::Layout make_layout() {
  world::Layout layout;
  std::size_t actuators = 0;
  for (const std::size_t count : {2, 0, 3}) {
    world::RobotLayout robot;
    robot.id = "robot" + std::to_string(layout.robots.size());
    robot.joint_actuators = {actuators, count};
    layout.robots.push_back(robot);
    actuators += count;
  }
  layout.joint_actuators.resize(actuators);
  return layout;
}

void receive_command(const wire::Inbox& inbox, const wire::Roster& roster,
                     const world::Layout& layout) {
  if (inbox.check(roster, layout)) return;
  world::Commands commands;
  commands.joint_targets.assign(layout.joint_actuators.size(), 0.0);
  inbox.apply(roster, commands);
  require(commands.joint_targets.size() == layout.joint_actuators.size());
  for (const double target : commands.joint_targets) require(std::isfinite(target));
  std::vector<wire::LogLine> lines;
  inbox.append_log(roster, lines);
  for (const wire::LogLine& line : lines) require(line.robot < layout.robots.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const world::Layout layout = make_layout();
  static const std::vector<std::size_t> held{0, 2};
  static const wire::Roster roster = wire::make_roster(layout, held);
  static wire::Inbox inbox;  // kept, as sessions keep theirs: nothing may leak between messages
  switch (inbox.parse({reinterpret_cast<const char*>(data), size})) {
    case wire::Inbox::Kind::malformed:
      break;
    case wire::Inbox::Kind::hello:
      inbox.hello();
      break;
    case wire::Inbox::Kind::command:
      receive_command(inbox, roster, layout);
      break;
    case wire::Inbox::Kind::leave:
      inbox.leave();
      inbox.check(roster, layout);
      break;
    case wire::Inbox::Kind::heartbeat:
      inbox.heartbeat();
      break;
  }
  return 0;
}
