// SPDX-License-Identifier: MIT
// Scripts against a real server: what reaches the world, and when.

#include "program/runner.h"

#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

#include "network/server.h"
#include "network/small_run.h"
#include "program/file_share.h"
#include "script/interrupt.h"
#include "script_fixture.h"
#include "waiting.h"

namespace ziggurat::lua {
namespace {

using network::Outcome;
using network::SmallRun;
using std::chrono::milliseconds;

constexpr network::Wait patience{milliseconds{20'000}, {}};

network::Config local_config() {
  network::Config config;
  config.endpoints = {"tcp://127.0.0.1:*"};
  return config;
}

/// Robots robot0 … robot2 with a joint `hinge` each that reads 100 * tick + i, all run by one
/// script; ticks 0 to 4.
class RunnerTest : public ScriptTest {
 protected:
  RunnerTest() : server_(local_config(), small_.run()) {}
  ~RunnerTest() override { allow_scripts(); }

  void run(const std::string& script) {
    write("main.lua", script);
    std::thread client([&] { has_failures_ = run_client(); });
    serve();
    client.join();
  }

  /// Log lines of tick `tick`; 5 is what came after the end.
  std::string logged_at(std::size_t tick) const {
    std::string text;
    for (const auto& line : reports_.at(tick).log) {
      text += std::to_string(line.robot) + (line.error ? "! " : ": ") + line.text + "\n";
    }
    return text;
  }

  const SmallRun small_{3};
  network::Server server_;
  world::Commands commands_ = small_.commands();
  std::vector<network::Report> reports_;
  bool has_script_ = true;  // otherwise the server names it
  bool trusts_scripts_ = false;
  bool has_failures_ = false;
  std::atomic<pthread_t> client_{};
  std::atomic<std::uint64_t> published_ = 0;  ///< ticks
  std::function<void(std::uint64_t)> before_tick_;

 private:
  bool run_client() {
    client_ = ::pthread_self();
    ProgramOptions program;
    if (has_script_) program.script = folder() / "main.lua";
    program.folders = {folder()};
    program.quiet = true;
    program.trusts_scripts = trusts_scripts_;
    ziggurat::Options options;
    options.endpoint = server_.endpoints().front();
    options.robots = {"*"};
    options.wait_timeout = milliseconds{20'000};
    options.is_interrupted = are_scripts_interrupted;
    ziggurat::Session session(options);
    Runner runner(session, program);
    runner.run();
    session.leave();
    return runner.has_failures();
  }

  /// Goes on when a signal woke the server: those that watch scripts are for the whole process,
  /// which has the server here, too.
  template <class Wait>
  static Outcome undisturbed(Wait wait) {
    Outcome outcome = wait();
    while (outcome == Outcome::woken) outcome = wait();
    return outcome;
  }

  void serve() {
    ASSERT_EQ(undisturbed([&] { return server_.gather(patience); }), Outcome::complete);
    for (std::uint64_t tick = 0; tick <= 4; ++tick) {
      if (before_tick_) before_tick_(tick);
      const world::Observations seen = small_.observations(tick);
      server_.publish(seen, network::no_tags);
      ++published_;
      ASSERT_EQ(undisturbed([&] { return server_.collect(commands_, patience); }),
                Outcome::complete);
      reports_.push_back(server_.take_report());
    }
    server_.finish({wire::EndReason::finished, "", 4});
    EXPECT_EQ(undisturbed([&] { return server_.drain(patience); }), Outcome::complete);
    reports_.push_back(server_.take_report());
  }
};

TEST_F(RunnerTest, ReadingsArriveAndTargetsAndLinesAreSent) {
  run("function init() log('init ', robot.joints.hinge.encoder) end "
      "function step() local hinge = robot.joints.hinge "
      "  log('step ', hinge.encoder) hinge.set_target(hinge.encoder / 2) end "
      "function destroy() logerr('destroy') end");
  EXPECT_FALSE(has_failures_);
  EXPECT_EQ(logged_at(0), "0: init 0\n1: init 1\n2: init 2\n");
  EXPECT_EQ(logged_at(1), "0: step 100\n1: step 101\n2: step 102\n");
  EXPECT_EQ(logged_at(5), "0! destroy\n1! destroy\n2! destroy\n");
  EXPECT_EQ(commands_.joint_targets, (std::vector<double>{200, 200.5, 201}));
}

TEST_F(RunnerTest, AFailureEndsOnlyItsRobot) {
  run("function init() robot.joints.hinge.set_target(3) end\n"
      "function step() n = (n or 0) + 1\n"
      "  if robot.id == 'robot1' and n == 2 then log('last words') nothing.x = 1 end end\n"
      "function destroy() log('destroy') end");
  EXPECT_TRUE(has_failures_);
  ASSERT_EQ(reports_[2].failures.size(), 1u);
  EXPECT_EQ(reports_[2].failures[0].robot, 1u);
  EXPECT_EQ(reports_[2].failures[0].tick, 2u);
  const std::string& message = reports_[2].failures[0].message;
  EXPECT_NE(message.find("main.lua:3: attempt to index a nil value (global 'nothing') (in step 2)\n"
                         "stack traceback:"),
            std::string::npos)
      << message;
  EXPECT_EQ(logged_at(2), "1: last words\n");
  EXPECT_EQ(logged_at(5), "0: destroy\n2: destroy\n");
  EXPECT_EQ(commands_.joint_targets, (std::vector<double>{3, 0, 3}));
}

TEST_F(RunnerTest, AScriptThatIsNotRunTellsTheServerNoFolders) {
  has_script_ = false;
  run("");
  EXPECT_TRUE(has_failures_);
  ASSERT_EQ(reports_[0].failures.size(), 3u);
  const std::string& told = reports_[0].failures[0].message;
  EXPECT_NE(told.find("the server names this script"), std::string::npos) << told;
  EXPECT_EQ(told.find(folder().string()), std::string::npos) << told;
}

TEST_F(RunnerTest, AllMayFailAndTheRunContinues) {
  run("function init() error('no') end");
  EXPECT_TRUE(has_failures_);
  EXPECT_EQ(reports_[0].failures.size(), 3u);
  EXPECT_EQ(reports_.size(), 6u);
}

TEST_F(RunnerTest, AFailureInDestroyIsOneOfItsRobot) {
  run("function init() end function step() end function destroy() error('late') end");
  EXPECT_TRUE(has_failures_);
  ASSERT_EQ(reports_[5].failures.size(), 3u);
  const std::string& message = reports_[5].failures[1].message;
  EXPECT_NE(message.find("main.lua:1: late (in destroy, after tick 4)"), std::string::npos)
      << message;
  EXPECT_EQ(logged_at(5), "");
}

/// Files below this folder that this process has open.
std::vector<std::string> open_files(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& each : std::filesystem::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    const auto file = std::filesystem::read_symlink(each.path(), error);
    if (!error && file.parent_path() == folder) names.push_back(file.filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST_F(RunnerTest, TheScriptOfARobotThatHasLeftEndsAndItsFilesAreClosed) {
  std::vector<std::string> open_at_the_end;
  before_tick_ = [&](std::uint64_t tick) {
    constexpr std::size_t robot = 1;
    if (tick == 2) server_.remove_robots({&robot, 1}, "It was removed.");
    if (tick == 4) open_at_the_end = open_files(folder());
  };
  const std::string own = "'" + folder().string() + "/' .. robot.id .. '.txt'";
  run("local file = io.open(" + own +
      ", 'w')\n"
      "function init() end\n"
      "function step() if robot.id == 'robot2' then nothing.x = 1 end end\n"
      "function destroy() file:write('end') log('destroy') end");
  EXPECT_EQ(open_at_the_end, std::vector<std::string>{"robot0.txt"});
  EXPECT_EQ(logged_at(2), "1: destroy\n");
  EXPECT_EQ(logged_at(5), "0: destroy\n");
  EXPECT_EQ(std::filesystem::file_size(folder() / "robot1.txt"), 3U);
}

TEST_F(RunnerTest, InvalidAndTooManyLinesAreHandled) {
  run("function init() end function step() if robot.id == 'robot0' then "
      "log('\\xff\\0\\x80') for i = 1, 100 do log(('x'):rep(100000)) end end "
      "log('here') end");
  EXPECT_FALSE(has_failures_);
  for (std::size_t tick = 1; tick <= 4; ++tick) {
    EXPECT_NE(logged_at(tick).find("1: here\n2: here\n"), std::string::npos);
  }
}

TEST_F(RunnerTest, AnInterruptLeavesWithoutFailure) {
  std::signal(SIGUSR1, [](int) { interrupt_scripts(); });
  std::thread interrupter([this] {
    // At tick 1 the script of robot1 loops.
    EXPECT_TRUE(comes_true([this] { return published_ >= 2; }));
    std::this_thread::sleep_for(
        milliseconds(20));             // no event tells that it loops; it ends before, too
    ::pthread_kill(client_, SIGUSR1);  // as a signal: where the script runs
  });
  run("function init() end function step() while robot.id == 'robot1' do end end");
  interrupter.join();
  std::signal(SIGUSR1, SIG_DFL);
  EXPECT_FALSE(has_failures_);
  for (const auto& report : reports_) EXPECT_TRUE(report.failures.empty());
  EXPECT_EQ(commands_.joint_targets, (std::vector<double>{0, 0, 0}));
}

TEST_F(RunnerTest, AnInterruptLeavesBeforeStatesAreFreed) {
  trusts_scripts_ = true;
  bool are_freed = true;
  before_tick_ = [&](std::uint64_t tick) {
    if (tick == 2) {
      interrupt_scripts();
      std::this_thread::sleep_for(milliseconds(700));  // the client looks every 500 ms
    }
    if (tick == 4) are_freed = std::filesystem::exists(folder() / "freed");
  };
  run("local until_then = setmetatable({}, {__gc = function()\n"
      "  local begin = os.clock()\n"
      "  while robot.id == 'robot2' and os.clock() < begin + 2 do end\n"
      "  if robot.id == 'robot2' then io.open('" +
      (folder() / "freed").string() +
      "', 'w'):close() end end})\n"
      "function init() end function step() return until_then end");
  EXPECT_FALSE(are_freed);
  EXPECT_TRUE(std::filesystem::exists(folder() / "freed"));
}

TEST(Files, AreSharedByTheRobotsOfAProcess) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit few = before;
  few.rlim_cur = 264;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  EXPECT_EQ(share_of_files(1), 32U);
  EXPECT_EQ(share_of_files(20), 10U);
  EXPECT_EQ(share_of_files(1000), 1U);
  open_more_files();
  rlimit after{};
  EXPECT_EQ(::getrlimit(RLIMIT_NOFILE, &after), 0);
  EXPECT_EQ(after.rlim_cur, before.rlim_max);
  ::setrlimit(RLIMIT_NOFILE, &before);
}

}  // namespace
}  // namespace ziggurat::lua
