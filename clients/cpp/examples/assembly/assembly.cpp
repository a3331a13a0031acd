// SPDX-License-Identifier: MIT
// Two robots, or any number of others, build what a rule table says, as
// scenes/construction/assembler.lua does. The table is the file that the Lua scripts read, too:
//   ziggurat run scenes/construction/steps.argos --controller robot=example_assembly
// A file after the program's name is the table instead of the scene's.

#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "assembler.h"

namespace assembly {
namespace {

struct Behaviour {
  const char* name;
  Next (*step)(Assembler&, Faces);
  bool is_working = false;  // others keep out of the robot's way
};

/// In the order of State.
constexpr Behaviour behaviours[] = {
    {"start", start},
    {"sense", sense, true},
    {"withdraw", withdraw, true},
    {"scan", scan},
    {"wander", wander},
    {"search", search},
    {"park", park},
    {"put_down", put_down},
    {"let_left_over_go", let_left_over_go},
    {"done", done},
    {"choose_block", choose_block},
    {"fetch", fetch},
    {"aim", aim},
    {"approach", approach, true},
    {"retreat", retreat, true},
    {"lower", lower, true},
    {"energise", energise, true},
    {"let_go", let_go, true},
    {"raise", raise, true},
    {"choose_side", choose_side},
    {"survey", survey},
    {"queue", queue},
    {"enter", enter},
    {"claim", claim},
    {"attach", attach, true},
    {"retreat_from_side", retreat_from_side, true},
    {"place", place, true},
    {"tell", tell, true},
    {"release", release, true},
    {"rise", rise, true},
    {"back_off", back_off, true},
};
static_assert(std::size(behaviours) == static_cast<std::size_t>(State::back_off) + 1);

const Behaviour& behaviour_of(State state) { return behaviours[static_cast<std::size_t>(state)]; }

void step(Assembler& self) {
  Job& job = self.job;
  ++job.since;
  reckon(self.odometry, self.builder, self.robot.imu("imu"));
  sense(self.traffic, *self.robot.range_and_bearing());
  const std::vector<construction::Face> faces = self.builder.faces();
  if (update(self.memory, self.odometry, self.builder.loaded, faces, self.plan, self.traffic)) {
    self.robot.log("lost: starts a new map");
  }
  if (const Next next = behaviour_of(job.state).step(self, faces)) {
    if (*next != job.state) self.robot.log(behaviour_of(*next).name);
    job.state = *next;
    job.since = 0;
    forget(self.travel);
  }
  self.traffic.working = behaviour_of(job.state).is_working;
  tell(self.traffic, *self.robot.range_and_bearing(), self.random);
  self.traffic.stopped = false;
  self.builder.move_lift();
}

/// The file of the table that the scene's parameter `rules` names, beside the robot's Lua script.
std::string table_of(const ziggurat::Robot& robot) {
  for (const auto& [name, value] : robot.params()) {
    if (name != "rules") continue;
    return (std::filesystem::path(robot.script()).parent_path() / (value + ".lua")).string();
  }
  throw std::runtime_error("robot '" + robot.id() + "' has no parameter 'rules'; name a file: " +
                           "example_assembly scenes/construction/rules_cross.lua");
}

Assembler begin(ziggurat::Robot& robot, const Plan& plan, const ziggurat::Session& session) {
  if (!robot.range_and_bearing()) {
    throw std::runtime_error("robot '" + robot.id() + "' has no range and bearing");
  }
  robot.log("start");
  return {.robot = robot,
          .plan = plan,
          .random = Random(session.seed(), robot.id()),
          .first_tick = session.tick(),
          .builder = construction::Builder(robot)};
}

void run(ziggurat::Session& session, const Plan& plan) {
  std::vector<Assembler> robots;
  while (session.next()) {
    if (session.event() == ziggurat::Event::step) {
      for (Assembler& robot : robots) step(robot);
    } else {  // init or reset
      robots.clear();
      for (ziggurat::Robot& robot : session.robots()) {
        robots.push_back(begin(robot, plan, session));
      }
    }
  }
}

}  // namespace
}  // namespace assembly

int main(int count, char** arguments) try {
  std::optional<assembly::Plan> plan;
  if (count > 1) plan = assembly::read_plan(arguments[1]);
  ziggurat::Session session(ziggurat::Options::from_environment());
  if (!plan) plan = assembly::read_plan(assembly::table_of(session.robots().front()));
  assembly::run(session, *plan);
} catch (const std::exception& error) {
  std::fprintf(stderr, "assembly: %s\n", error.what());
  return 1;
}
