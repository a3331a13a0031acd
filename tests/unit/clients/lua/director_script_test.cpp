// SPDX-License-Identifier: MIT
// Scripts of directors, against a server that the test scripts.

#include "script/director_script.h"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <regex>

#include "clients/fake_director.h"
#include "program/director_runner.h"
#include "temporary_folder.h"

namespace ziggurat::lua {
namespace {

using Directions = std::vector<v1::Direction>;

struct Directed {
  Directions directions;  // by tick
  v1::Leave leave;
  bool is_well = false;

  /// All log lines.
  std::vector<std::string> log() const {
    std::vector<std::string> lines;
    for (const v1::Direction& each : directions) {
      for (const v1::LogLine& line : each.log()) lines.push_back(line.text());
    }
    for (const v1::LogLine& line : leave.log()) lines.push_back(line.text());
    return lines;
  }
};

/// Runs a script for some ticks. Beside it is `floor.pgm`; FOLDER stands for its folder.
Directed run(const std::string& script, std::uint64_t ticks = 1,
             const std::function<void(FakeServer&, std::uint64_t)>& before_tick = {}) {
  const TemporaryFolder folder;
  ProgramOptions options;
  options.director = "judge";
  options.script = folder / "main.lua";
  options.folders = {folder.path};
  options.quiet = true;
  std::ofstream(folder / "floor.pgm") << "P5 1 1 255\nx";
  std::ofstream(*options.script) << std::regex_replace(script, std::regex("FOLDER"),
                                                       folder.path.string());
  Directed directed;
  {
    FakeServer server([&](FakeServer& self) {
      self.welcome(judge());
      self.send(arm_and_box());
      for (std::uint64_t tick = 0; tick <= ticks; ++tick) {
        if (before_tick) before_tick(self, tick);
        self.send(full_state(tick, 0));
        const auto answer = self.receive();
        if (answer.has_leave()) {
          directed.leave = answer.leave();
          return;
        }
        directed.directions.push_back(answer.direction());
        if (answer.direction().has_finish()) break;
      }
      self.end();
      directed.leave = self.receive().leave();
    });
    DirectorOptions wanted = options_of(server);
    wanted.groups.assign(wanted.all_groups.begin(), wanted.all_groups.end());
    Director director(wanted);
    directed.is_well = run_director(director, options);
  }
  return directed;
}

/// Log of a script of one line in init(); its failure if it fails.
std::string logged(const std::string& line) {
  const Directed directed = run("function init() " + line + " end");
  if (!directed.is_well) return directed.leave.message();
  std::string text;
  for (const std::string& each : directed.log()) text += (text.empty() ? "" : "|") + each;
  return text;
}

TEST(DirectorScript, IsCalledInItsOrder) {
  const Directed directed = run(R"(
    function init() log("init ", world.tick, " ", world.first_tick, " ", world.id, " ", world.params.goal) end
    function pre_step(tick) log("pre ", tick) end
    function post_step(tick) log("post ", tick, " ", world.tick, " ", world.time) end
    function is_finished() log("finished?") return world.tick == 2 end
    function destroy() log("destroy") end
  )",
                                10);
  EXPECT_TRUE(directed.is_well);
  EXPECT_EQ(directed.log(),
            (std::vector<std::string>{"init 0 0 judge 3", "pre 1", "post 1 1 0.05", "finished?",
                                      "pre 2", "post 2 2 0.1", "finished?", "destroy"}));
  ASSERT_EQ(directed.directions.size(), 3U);
  EXPECT_TRUE(directed.directions[2].has_finish());
  EXPECT_EQ(directed.leave.reason(), v1::Leave::DONE);
}

TEST(DirectorScript, TellsOfNamesThatNothingCalls) {
  EXPECT_EQ(run("function init() end function poststep() end").log(),
            std::vector<std::string>{"nothing calls poststep(); did you mean post_step()?"});
  EXPECT_TRUE(run("function post_step() end function poststep() end").log().empty())
      << "its own function";
}

TEST(DirectorScript, BeginsAnewAfterAReset) {
  const auto reset = [](FakeServer& self, std::uint64_t tick) {
    if (tick != 1) return;
    v1::ServerMessage message;
    message.mutable_reset()->set_seed(7);
    self.send(message);
  };
  const Directed directed = run(R"(
    function init() log(world.random.uniform()) end
    function reset() log(world.random.uniform()) end
    function post_step() log("post") end
  )",
                                1, reset);
  ASSERT_EQ(directed.log().size(), 2U);
  EXPECT_EQ(directed.log()[0], directed.log()[1]) << "the same seed gives the same numbers";
}

TEST(DirectorScript, SeesEntitiesAsTheyAre) {
  EXPECT_EQ(logged("for id, e in pairs(world.entities) do log(id, ' ', e.id, ' ', e.kind, ' ', "
                   "e.controller) end"),
            "arm arm prototype swing|box box box ");
  EXPECT_EQ(logged("log(world.entities.box.position.z)"), "9");
  EXPECT_EQ(
      logged("local o = world.entities.arm.orientation log(type(o.angle), ' ', type(o.axis.x))"),
      "number number");
  EXPECT_EQ(
      logged("local arm = world.entities.arm log(arm.links.tip.position.x, ' ', #arm.links, ' ', "
             "arm.links[1].velocity.y)"),
      "13 2 8");
  EXPECT_EQ(logged("local box = world.entities.box log(box.velocity.x, ' ', "
                   "box.angular_velocity.z, ' ', box.removed)"),
            "33 38 0");
  EXPECT_EQ(
      logged("log(world.entities.arm.joints.hinge.velocity, ' ', world.entities.arm.leds[1].red)"),
      "-2 255");
  EXPECT_EQ(logged("local c = world.contacts() log(#c, ' ', c[1].first, ' ', c[1].first_link, ' ', "
                   "c[1].second, ' ', "
                   "c[1].force.z, ' ', c[2].with_floor)"),
            "2 arm tip box 8 1");
  EXPECT_EQ(logged("local m = world.messages()[1] log(m.receiver, m.radio, m.sender, m.data[2])"),
            "arm1arm105");
}

TEST(DirectorScript, KeepsWhatItWritesIntoEntities) {
  const Directed directed = run(R"(
    function init() world.entities.box.carrier = "arm" end
    function post_step() log(world.entities.box.carrier) end
  )");
  EXPECT_EQ(directed.log(), std::vector<std::string>{"arm"});
}

TEST(DirectorScript, PlacesAreVectorsAndOrientationsQuaternions) {
  const Directed directed = run(R"(
    function init()
      local box = world.entities.box
      local turn = quaternion(1, vector3(0, 0, 1))
      world.move(box, box.position + vector3(0, 0, 1), turn * turn)
      world.move(box, -(box.position - 2 * box.position), {angle = 2, axis = {x = 0, y = 0, z = 1}})
      log((box.orientation * box.orientation:inverse()).x, ' ', (turn * turn:inverse()).w)
    end
  )",
                                0);
  ASSERT_EQ(directed.directions.size(), 1U) << directed.leave.message();
  EXPECT_EQ(directed.log(), std::vector<std::string>{"0 1"});
  const auto &first = directed.directions[0].acts(0).move(),
             &second = directed.directions[0].acts(1).move();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(first.position(i), second.position(i) + (i == 2 ? 1 : 0));
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(first.orientation(i), second.orientation(i), 1e-12);
}

TEST(DirectorScript, ActsInTheOrderOfItsCalls) {
  const Directed directed = run(R"(
    function init()
      local box = world.entities.box
      world.move(box, {x = 1, y = 2, z = 3}, {angle = math.pi, axis = {x = 0, y = 0, z = 2}})
      world.move("box", {x = 1, y = 2, z = 3})
      world.spawn('<box id="new"/>')
      world.remove(box)
      world.push("arm", {x = 1, y = 0, z = 0}, nil, "tip")
      world.set_leds("arm", "blue")
      world.set_leds("arm", {"red", "0,1,2,255"})
      world.set_joint("arm", "hinge", -0.5)
      world.set_joint(world.entities.arm, "hinge", 1, 2.5)
      world.floor.paint({x = 1, y = 2, radius = 0.5}, "red")
      world.floor.paint({x = 1, y = 2, width = 3, height = 4}, "0,1,2,255")
      world.metric("height", 0.5)
      metric("width", 2)
    end
  )",
                                0);
  ASSERT_EQ(directed.directions.size(), 1U) << directed.leave.message();
  const v1::Direction& all = directed.directions[0];
  ASSERT_EQ(all.acts_size(), 11);
  EXPECT_NEAR(all.acts(0).move().orientation(0), 0, 1e-15);
  EXPECT_NEAR(all.acts(0).move().orientation(3), 1, 1e-15);
  EXPECT_EQ(all.acts(1).move().orientation_size(), 0);
  EXPECT_EQ(all.acts(2).spawn().xml(), "<box id=\"new\"/>");
  EXPECT_EQ(all.acts(3).remove().entity(), "box");
  EXPECT_EQ(all.acts(4).push().link(), "tip");
  EXPECT_EQ(all.acts(4).push().torque(0), 0);
  EXPECT_EQ(all.acts(5).show().led_colors(1), 0x0000ffU);
  EXPECT_EQ(all.acts(6).show().led_colors(1), 0x000102U);
  EXPECT_EQ(all.acts(7).set_joint().entity(), "arm");
  EXPECT_EQ(all.acts(7).set_joint().joint(), "hinge");
  EXPECT_EQ(all.acts(7).set_joint().position(), -0.5);
  EXPECT_EQ(all.acts(7).set_joint().velocity(), 0);
  EXPECT_EQ(all.acts(8).set_joint().velocity(), 2.5);
  EXPECT_EQ(all.acts(9).paint_floor().color(), 0xff0000U);
  EXPECT_EQ(all.acts(9).paint_floor().size_size(), 1) << "a disc";
  EXPECT_EQ(all.acts(9).paint_floor().size(0), 0.5);
  EXPECT_EQ(all.acts(10).paint_floor().color(), 0x000102U);
  EXPECT_EQ(all.acts(10).paint_floor().center(1), 2);
  EXPECT_EQ(all.acts(10).paint_floor().size(1), 4);
  ASSERT_EQ(all.metrics_size(), 2);
  EXPECT_EQ(all.metrics(1).name(), "width");
}

TEST(DirectorScript, LaysImagesThatItMayRead) {
  const Directed directed =
      run("function init() world.floor.image('FOLDER/floor.pgm') io = nil "
          "world.floor.image('FOLDER/floor.pgm') end",
          0);
  ASSERT_EQ(directed.directions.size(), 1U) << directed.leave.message();
  ASSERT_EQ(directed.directions[0].acts_size(), 2);
  EXPECT_EQ(directed.directions[0].acts(1).paint_floor().image(), "P5 1 1 255\nx");
  const std::string refused = logged("world.floor.image('/etc/hostname')");
  EXPECT_NE(refused.find("is not a file that scripts may use"), std::string::npos) << refused;
}

TEST(DirectorScript, SaysWhatIsWrong) {
  const auto has = [](const std::string& line, const std::string& part) {
    const std::string text = logged(line);
    EXPECT_NE(text.find(part), text.npos) << line << ": " << text;
    EXPECT_NE(text.find("main.lua:1:"), text.npos) << text;
  };
  has("world.entities.box.position = {x = 1}", "position of an entity can't be set; world.move");
  has("world.move('box', {x = 1, y = 2})", "finite numbers {x =, y =, z =} expected");
  has("world.move('box', {x = 0/0, y = 2, z = 3})", "finite numbers");
  has("world.move(nil, {x = 1, y = 2, z = 3})", "an entity or its id expected");
  has("world.move('box', {x = 1, y = 2, z = 3}, {angle = 1, axis = {x = 0, y = 0, z = 0}})",
      "must have a length");
  has("world.set_joint('arm', 'hinge')", "world.set_joint(entity, joint, position [, velocity])");
  has("world.set_joint('arm', 'hinge', 0/0)", "finite number expected");
  has("world.set_joint('arm', 7, 0)", "string expected");
  has("world.spawn(7)", "string expected");
  has("world.set_leds('box', {'red'})", "'box' has no LEDs");
  has("world.set_directional_leds('box', 'red')", "'box' has no directional LEDs");
  has("world.set_tags('box', 'x')", "'box' has no tags");
  has("world.set_leds('arm', 'reddish')", "'reddish' is no color");
  has("world.set_leds('missing', 'red')", "no entity 'missing' is in the world");
  has("world.floor.paint({x = 1, y = 2}, 'red')", "{x =, y =, radius =} or {x =, y =, width =,");
  has("world.floor.paint({x = 1, y = 2, radius = 0}, 'red')", "a size above 0");
  has("world.floor.paint({x = 1, y = 2, radius = 1}, 'reddish')", "'reddish' is no color");
  has("world.floor.image('FOLDER/no.png')", "no.png: No such file or directory");
  has("world.floor.image()", "world.floor.image(path)");
  has("world.finish(string.rep('x', 2000))", "at most 1024 bytes");
  has("world.metric('a b', 1)", "the name of a metric");
  has("for i = 1, 10001 do world.remove('box') end", "at most 10000 things");
}

TEST(DirectorScript, ThatFailsLeavesTheRun) {
  const Directed directed = run("function post_step() error('no food') end");
  EXPECT_FALSE(directed.is_well);
  EXPECT_EQ(directed.leave.reason(), v1::Leave::FAILED);
  EXPECT_NE(directed.leave.message().find("main.lua:1: no food (in post_step 1)"),
            std::string::npos)
      << directed.leave.message();
  EXPECT_NE(run("x = 1").leave.message().find("none of the functions init(), pre_step(tick)"),
            std::string::npos);
  EXPECT_NE(run("function init() os.execute('ls') end").leave.message().find("not allowed"),
            std::string::npos);
}

TEST(DirectorScript, EntitiesThatAreGoneAreNoMoreInTheList) {
  const auto remove_box = [](FakeServer& self, std::uint64_t tick) {
    if (tick != 1) return;
    v1::ServerMessage message;
    message.mutable_world_layout()->set_first(2);
    message.mutable_world_layout()->add_removed(1);
    self.send(message);
  };
  const Directed directed = run(R"(
    function init() box = world.entities.box end
    function post_step()
      log(world.entities.box == nil, " ", box.removed, " ", box.id)
      log(select(2, pcall(function() return box.position end)))
    end
  )",
                                1, remove_box);
  ASSERT_EQ(directed.log().size(), 2U) << directed.leave.message();
  EXPECT_EQ(directed.log()[0], "1 1 box");
  EXPECT_NE(directed.log()[1].find("entity 'box' is not in the world any more: it has no position"),
            std::string::npos);
}

}  // namespace
}  // namespace ziggurat::lua
