// Real sockets, real clients in threads: the barrier as a run sees it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <numeric>
#include <thread>

#include "network/local_server.h"
#include "network/small_run.h"
#include "ziggurat/ziggurat.h"

namespace ziggurat::network {
namespace {

using std::chrono::milliseconds;

Options options_for(const Server& server, std::vector<std::string> robots) {
  Options options;
  options.endpoint = server.endpoints().front();
  options.robots = std::move(robots);
  options.name = "test";
  options.wait_timeout = milliseconds{20'000};
  return options;
}

/// Ticks 0 … `last`, each reading of robot i being 100 * tick + i.
void serve(Server& server, const SmallRun& small, std::uint64_t last, world::Commands& commands,
           std::vector<Report>* reports = nullptr) {
  ASSERT_EQ(server.gather(patience), Outcome::complete);
  for (std::uint64_t tick = 0; tick <= last; ++tick) {
    const world::Observations seen = small.observations(tick);
    server.publish(seen, no_tags);
    ASSERT_EQ(server.collect(commands, patience), Outcome::complete);
    if (reports != nullptr) reports->push_back(server.take_report());
  }
  server.finish({wire::EndReason::finished, "", last});
  EXPECT_EQ(server.drain(patience), Outcome::complete);
  if (reports != nullptr) reports->push_back(server.take_report());
}

TEST(EndToEnd, AnswersReachTheWorldAndReadingsTheClients) {
  const SmallRun small(3);
  Server server(local_config(), small.run());
  const auto drive = [&](std::vector<std::string> robots) {
    ziggurat::Session session(options_for(server, std::move(robots)));
    std::uint64_t expected = 0;
    while (session.next()) {
      EXPECT_EQ(session.event(), expected == 0 ? Event::init : Event::step);
      EXPECT_EQ(session.tick(), expected++);
      for (Robot& robot : session.robots()) {
        Joint& joint = robot.joint("hinge");
        joint.set_target(joint.encoder() + 0.5);
      }
    }
    EXPECT_EQ(expected, 21U);
    ASSERT_TRUE(session.ending());
    EXPECT_EQ(session.ending()->reason, Ending::Reason::finished);
    EXPECT_EQ(session.ending()->tick, 20U);
  };
  std::thread first(drive, std::vector<std::string>{"robot0", "robot2"});
  std::thread second(drive, std::vector<std::string>{"robot1"});
  world::Commands commands = small.commands();
  serve(server, small, 20, commands);
  first.join();
  second.join();
  EXPECT_EQ(commands.joint_targets, (std::vector<double>{2000.5, 2001.5, 2002.5}));
}

TEST(EndToEnd, LogLinesComeInSceneOrderInAnyOrderOfAnswers) {
  const SmallRun small(3);
  Server server(local_config(), small.run());
  const auto drive = [&](std::vector<std::string> robots, milliseconds pause) {
    ziggurat::Session session(options_for(server, std::move(robots)));
    while (session.next()) {
      std::this_thread::sleep_for(pause);  // its answers come in another order
      for (Robot& robot : session.robots()) {
        robot.log(robot.id() + " a");
        robot.log_error(robot.id() + " b");
      }
    }
    session.robots()[0].log("last words");
  };
  std::thread slow(drive, std::vector<std::string>{"robot0"}, milliseconds{20});
  std::thread fast(drive, std::vector<std::string>{"robot2", "robot1"}, milliseconds{0});
  world::Commands commands = small.commands();
  std::vector<Report> reports;
  serve(server, small, 1, commands, &reports);
  slow.join();
  fast.join();
  ASSERT_EQ(reports.size(), 3U);
  for (int tick = 0; tick < 2; ++tick) {
    std::string text;
    for (const auto& line : reports[tick].log) text += line.text + (line.error ? "! " : " ");
    EXPECT_EQ(text, "robot0 a robot0 b! robot1 a robot1 b! robot2 a robot2 b! ");
  }
  ASSERT_EQ(reports[2].log.size(), 2U);
  EXPECT_EQ(reports[2].log[0].robot, 0U);
  EXPECT_EQ(reports[2].log[1].robot, 1U);
}

TEST(EndToEnd, AFailedRobotLeavesTheBarrierAndTheOthersGoOn) {
  const SmallRun small(2);
  Server server(local_config(), small.run());
  std::thread client([&] {
    ziggurat::Session session(options_for(server, {"*"}));
    while (session.next()) {
      for (Robot& robot : session.robots()) robot.joint("hinge").set_target(7);
      if (session.tick() == 2) {
        session.robot("robot0").log("before the fall");
        session.robot("robot0").fail("script.lua:3: no such joint");
      }
    }
  });
  world::Commands commands = small.commands();
  std::vector<Report> reports;
  serve(server, small, 4, commands, &reports);
  client.join();
  EXPECT_EQ(commands.joint_targets, (std::vector<double>{0, 7}));
  ASSERT_EQ(reports[2].failures.size(), 1U);
  EXPECT_EQ(reports[2].failures[0].robot, 0U);
  EXPECT_EQ(reports[2].failures[0].tick, 2U);
  EXPECT_EQ(reports[2].failures[0].message, "script.lua:3: no such joint");
  ASSERT_EQ(reports[2].log.size(), 1U);
  EXPECT_TRUE(reports[1].failures.empty());
  EXPECT_TRUE(reports[3].failures.empty());
}

TEST(EndToEnd, AnExceptionInTheLoopLeavesAsFailed) {
  const SmallRun small(1);
  Server server(local_config(), small.run());
  std::thread client([&] {
    try {
      ziggurat::Session session(options_for(server, {"*"}));
      while (session.next()) {
        session.robots()[0].joint("hinge").set_target(1);
        if (session.tick() == 1) throw std::runtime_error("oh");
      }
    } catch (const std::runtime_error&) {
    }
  });
  world::Commands commands = small.commands();
  std::vector<Report> reports;
  serve(server, small, 3, commands, &reports);
  client.join();
  ASSERT_EQ(reports[1].failures.size(), 1U);
  EXPECT_EQ(commands.joint_targets[0], 0);
}

TEST(EndToEnd, AWishForADeadlineIsGrantedAndMissesAreCounted) {
  const SmallRun small(1);
  Server server(local_config(), small.run());
  std::uint64_t missed = 0;
  std::thread client([&] {
    auto options = options_for(server, {"*"});
    options.deadline = {Deadline::Action::hold, milliseconds{200}, 0};
    ziggurat::Session session(options);
    while (session.next()) {
      if (session.tick() == 1)
        std::this_thread::sleep_for(milliseconds{500});  // longer than its deadline
    }
    missed = session.missed();
  });
  world::Commands commands = small.commands();
  serve(server, small, 2, commands);
  client.join();
  EXPECT_GE(missed, 1U);
  const Performance performance = server.performance();
  EXPECT_GE(performance.controllers[0].missed_ticks, 1U);
  const auto& times = performance.controllers[0].answer_times.counts;
  const auto answers = std::accumulate(times.begin(), times.end(), std::uint64_t{0});
  EXPECT_GE(answers, 1U) << "in time";
}

TEST(EndToEnd, AReadableDescriptorWakesTheWait) {
  const SmallRun small(1);
  Server server(local_config(), small.run());
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const std::array<int, 1> descriptors{ends[0]};
  EXPECT_EQ(server.gather({milliseconds{10}, descriptors}), Outcome::timed_out);
  ASSERT_EQ(::write(ends[1], "x", 1), 1);
  EXPECT_EQ(server.gather({milliseconds{20'000}, descriptors}), Outcome::woken);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(EndToEnd, IpcAndTcpAtOnce) {
  const SmallRun small(2);
  Config config = local_config();
  config.endpoints.push_back("ipc://@ziggurat-test-" + std::to_string(::getpid()));
  Server server(config, small.run());
  ASSERT_EQ(server.endpoints().size(), 2U);
  const auto drive = [&](std::size_t endpoint) {
    Options options = options_for(server, {"robot" + std::to_string(endpoint)});
    options.endpoint = server.endpoints()[endpoint];
    ziggurat::Session session(options);
    while (session.next()) {
    }
  };
  std::thread tcp(drive, 0);
  std::thread ipc(drive, 1);
  world::Commands commands = small.commands();
  serve(server, small, 3, commands);
  tcp.join();
  ipc.join();
}

TEST(EndToEnd, APortThatIsTakenIsOneClearError) {
  const SmallRun small(1);
  Server server(local_config(), small.run());
  Config config;
  config.endpoints = {server.endpoints().front()};
  try {
    const Server second(config, small.run());
    FAIL() << "bound twice";
  } catch (const EndpointError& error) {
    EXPECT_NE(std::string(error.what()).find("taken"), std::string::npos) << error.what();
  }
}

TEST(EndToEnd, AServerThatDiesIsNoticed) {
  const SmallRun small(1);
  auto server = std::make_unique<Server>(local_config(), small.run());
  Options options = options_for(*server, {"*"});
  options.wait_timeout.reset();
  std::thread client([&] {
    ziggurat::Session session(options);
    EXPECT_THROW(session.next(), ConnectionError);
    EXPECT_FALSE(session.next());
  });
  ASSERT_EQ(server->gather(patience), Outcome::complete);
  server.reset();
  client.join();
}

}  // namespace
}  // namespace ziggurat::network
