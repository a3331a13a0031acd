// SPDX-License-Identifier: MIT
// A recording has what it takes to repeat the run.

#include "recording/recorder/recorder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "recording/mcap/messages.h"
#include "recording/mcap/scan.h"
#include "recording/recorder/overview.h"
#include "shown_world.h"

namespace ziggurat::recorder {
namespace {

using channels::testing::ShownWorld;

struct File {
  std::string path = ::testing::TempDir() + "recorder_test_" + std::to_string(::getpid()) + ".mcap";
  ~File() { std::remove(path.c_str()); }
};

/// A world on its way into a recording.
struct Recorded : ShownWorld {
  explicit Recorded(const std::string& path, Contents contents = {},
                    std::chrono::milliseconds patience = std::chrono::seconds(30))
      : recorder({path, mcap::Compression::none, std::move(contents), patience}, start()) {
    populate();
  }
  static Start start() {
    Start start;
    start.scene = "small.argos";
    start.seed = 1;
    start.build.version = "1";
    start.files = {{"small.argos", "<argos/>"}};
    return start;
  }
  void populate() {
    recorder.populate({scene, path, scene_hash, 1, 0, simulation.layout(), simulation.entities(),
                       simulation.state()});
  }
  void publish() {
    hashes.push_back(simulation.hash());
    recorder.tick({simulation.state(),
                   simulation.observations(),
                   simulation.commands(),
                   simulation.contacts(),
                   {}});
  }
  void step(double target) {
    simulation.commands().joint_targets = {target};
    recorder.step(simulation.commands());
    simulation.step();
  }

  std::vector<std::uint64_t> hashes;
  Recorder recorder;
};

template <class Type>
std::vector<Type> read(const mcap::Reader& reader, const std::string& topic) {
  std::vector<Type> all;
  const mcap::Channel* channel = reader.contents().channel_of(topic);
  if (!channel) return all;
  mcap::Messages messages(reader, {{channel->id}});
  while (const auto message = messages.next()) {
    EXPECT_TRUE(all.emplace_back().ParseFromArray(message->data.data(),
                                                  static_cast<int>(message->data.size())));
  }
  return all;
}

TEST(Recorder, HasWhatItTakesToRepeatTheRun) {
  const File file;
  Recorded run(file.path);
  math::Pose there;
  there.position = {0.3, -0.5, 0.2};
  for (int i = 0; i < 4; ++i) {
    run.publish();
    if (i == 2) {
      run.simulation.move(1, there);
      run.recorder.moved("crate", there);
    }
    run.step(0.1 * i);
  }
  run.publish();
  run.recorder.reset(7);
  run.simulation.reset(run.scene, {7, {}});
  run.populate();
  for (int i = 0; i < 3; ++i) {
    run.publish();
    run.step(1);
  }
  run.publish();
  run.recorder.close();
  EXPECT_FALSE(run.recorder.take_failure());

  const mcap::Reader reader(mcap::open_file(file.path));
  EXPECT_TRUE(mcap::check(mcap::open_file(file.path)).faults.empty());
  const auto inputs = read<v1::Inputs>(reader, "/inputs");
  ASSERT_EQ(inputs.size(), run.hashes.size());
  simulation::Simulation again(run.scene, {1, {}});
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    EXPECT_EQ(inputs[i].hash(), run.hashes[i]) << i;
    EXPECT_EQ(again.hash(), run.hashes[i]) << i;
    EXPECT_EQ(inputs[i].epoch(), i < 5 ? 0u : 1u);
    EXPECT_EQ(inputs[i].tick(), i < 5 ? i : i - 5);
    for (const v1::Act& act : inputs[i].acts()) {
      if (act.has_move()) {
        math::Pose pose;
        for (int j = 0; j < 3; ++j) pose.position[j] = act.move().position(j);
        again.move(1, pose);
      }
      if (act.has_reset()) again.reset(run.scene, {act.reset().seed(), {}});
    }
    if (!inputs[i].has_commands()) continue;
    const v1::Commands& commands = inputs[i].commands();
    if (commands.has_joint_targets()) {
      again.commands().joint_targets.assign(commands.joint_targets().values().begin(),
                                            commands.joint_targets().values().end());
    }
    again.step();
  }
  EXPECT_FALSE(inputs.back().has_commands());
  EXPECT_FALSE(inputs[4].has_commands());
  EXPECT_TRUE(inputs[5].commands().has_led_colors()) << "an epoch begins with all arrays";
  EXPECT_FALSE(inputs[6].commands().has_joint_targets()) << "as before";
}

TEST(Recorder, TimesNeverFallAndEachTickHasItsMessages) {
  const File file;
  Recorded run(file.path);
  run.publish();
  run.step(1);
  run.publish();
  run.recorder.reset(1);
  run.simulation.reset(run.scene, {1, {}});
  run.populate();
  run.publish();
  run.recorder.log(channels::Severity::info, "arm", "hello");
  run.recorder.close();
  const mcap::Reader reader(mcap::open_file(file.path));
  mcap::Messages messages(reader, {});
  std::uint64_t last = 0;
  while (const auto message = messages.next()) {
    EXPECT_GE(message->log_time, last);
    last = message->log_time;
  }
  EXPECT_EQ(last, 200'000'000u) << "the second epoch begins a tick after the first ends";
  EXPECT_EQ(read<v1::World>(reader, "/world").size(), 2u);
  EXPECT_EQ(read<v1::Poses>(reader, "/poses").size(), 3u);
  EXPECT_EQ(read<v1::Command>(reader, "/robots/arm/command").size(), 1u);
  EXPECT_EQ(read<foxglove::Log>(reader, "/log").at(0).message(), "hello");
  const auto states = read<v1::ExactState>(reader, "/state");
  ASSERT_EQ(states.size(), 3u);
  EXPECT_TRUE(states[0].is_complete());
  EXPECT_FALSE(states[1].is_complete());
  EXPECT_TRUE(states[2].is_complete());
  EXPECT_EQ(reader.contents().channel_of("/phases"), nullptr);
  EXPECT_EQ(reader.contents().channel_of("/metrics"), nullptr);  // /inputs has them
  const Overview seen = overview(reader);
  EXPECT_EQ(seen.epochs, 2u);
  EXPECT_EQ(seen.states, 3u);
  EXPECT_EQ(seen.start->scene, "small.argos");
}

TEST(Recorder, KeepsOnlyWhatIsWanted) {
  const File file;
  Contents contents;
  contents.wants = [](std::string_view topic) { return topic == "/poses"; };
  Recorded run(file.path, contents);
  EXPECT_FALSE(run.recorder.wants("/contacts"));
  run.publish();
  run.step(1);
  run.recorder.close();
  const mcap::Reader reader(mcap::open_file(file.path));
  std::vector<std::string> topics;
  for (const auto& [id, channel] : reader.contents().channels) topics.push_back(channel.topic);
  EXPECT_EQ(topics, (std::vector<std::string>{"/run", "/inputs", "/poses"}));
}

TEST(Recorder, EmbedsASnapshotOnceHoweverOftenItIsRestored) {
  const File file;
  Recorded run(file.path);
  const std::vector<std::byte> one(1000, std::byte{1}), other(1000, std::byte{2});
  for (const auto& bytes : {one, other, one}) {
    run.publish();
    run.recorder.restored("a name", bytes);
  }
  run.publish();
  run.recorder.close();
  const mcap::Reader reader(mcap::open_file(file.path));
  std::vector<std::string> names;
  for (const auto& each : reader.contents().attachments) names.push_back(each.name);
  std::vector<std::string> restored;
  for (const v1::Inputs& inputs : read<v1::Inputs>(reader, "/inputs")) {
    for (const v1::Act& act : inputs.acts()) restored.push_back("snapshot/" + act.restore().file());
  }
  ASSERT_EQ(restored.size(), 3u);
  ASSERT_EQ(names, (std::vector<std::string>{"small.argos", restored[0], restored[1]}));
  EXPECT_EQ(restored[2], restored[0]);
  EXPECT_EQ(reader.attachment(reader.contents().attachments[2]), std::string(1000, '\2'));
}

TEST(Recorder, AFullDiskHoldsUpNothing) {
  Recorded run("/dev/full");
  for (int i = 0; i < 2000; ++i) {  // more than may wait
    run.publish();
    run.recorder.step(run.simulation.commands());
  }
  run.recorder.close();
  const auto why = run.recorder.take_failure();
  ASSERT_TRUE(why);
  EXPECT_EQ(*why, "/dev/full: cannot be written: No space left on device");
  EXPECT_FALSE(run.recorder.take_failure()) << "once";
}

TEST(Recorder, AFileThatIsShortenedOrRemovedIsToldWhileTheRunGoesOn) {
  const auto failure_after = [](int (*harm)(const char*)) -> std::string {
    const File file;
    Recorded run(file.path);
    struct stat status {};
    const auto grows_beyond = [&](off_t size) {
      for (int i = 0; i < 5000; ++i) {
        run.publish();
        run.step(1);
        if (::stat(file.path.c_str(), &status) == 0 && status.st_size > size) return true;
      }
      return false;
    };
    EXPECT_TRUE(grows_beyond(1 << 17));
    harm(file.path.c_str());
    grows_beyond(1 << 28);
    return run.recorder.take_failure().value_or("");
  };
  const std::string shortened =
      failure_after([](const char* path) { return ::truncate(path, 100); });
  EXPECT_NE(shortened.find("was shortened by another program while it was written"),
            std::string::npos)
      << shortened;
  const std::string removed = failure_after([](const char* path) { return ::unlink(path); });
  EXPECT_NE(removed.find("was removed while it was written, and is lost"), std::string::npos)
      << removed;
}

/// A disk that takes what its pipe holds, and more only when it is read.
struct Pipe {
  Pipe() {
    std::signal(SIGPIPE, SIG_IGN);  // as the program does
    EXPECT_EQ(::mkfifo(file.path.c_str(), 0600), 0);
    reader = ::open(file.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    EXPECT_GE(reader, 0);
  }
  ~Pipe() { ::close(reader); }
  File file;
  int reader = -1;
};
constexpr std::chrono::milliseconds short_patience{300};

TEST(Recorder, ADiskThatTakesNothingIsWaitedForForAWhileOnly) {
  const Pipe pipe;
  Recorded run(pipe.file.path, {}, short_patience);
  for (int i = 0; i < 5000; ++i) {  // more than may wait: the run waits once
    run.publish();
    run.recorder.step(run.simulation.commands());
  }
  const auto why = run.recorder.take_failure();
  ASSERT_TRUE(why);
  EXPECT_EQ(*why, pipe.file.path + ": cannot be written: the disk has taken nothing for 0.3 s");
  run.recorder.close();  // at once
  EXPECT_FALSE(run.recorder.take_failure()) << "once";
}

TEST(Recorder, ADiskThatTakesNothingAtTheEndDoesNotHoldUpTheEnd) {
  const Pipe pipe;
  Recorded run(pipe.file.path, {}, short_patience);
  for (int i = 0; i < 400; ++i) {
    run.publish();
    run.recorder.step(run.simulation.commands());
  }
  EXPECT_FALSE(run.recorder.take_failure());
  run.recorder.close();
  const auto why = run.recorder.take_failure();
  ASSERT_TRUE(why);
  EXPECT_NE(why->find("the disk has taken nothing for"), std::string::npos) << *why;
}

/// Longer in all than the patience, which counts from the last byte on.
TEST(Recorder, ASlowDiskIsWaitedFor) {
  constexpr std::chrono::milliseconds patience{3000};
  Pipe pipe;
  std::string got;
  std::atomic<bool> is_over = false;
  std::thread disk([&] {
    std::string block(4096, '\0');
    while (!is_over) {
      std::this_thread::sleep_for(patience / 100);
      const ssize_t count = ::read(pipe.reader, block.data(), block.size());
      if (count > 0) got.append(block, 0, static_cast<std::size_t>(count));
    }
    for (ssize_t count; (count = ::read(pipe.reader, block.data(), block.size())) > 0;) {
      got.append(block, 0, static_cast<std::size_t>(count));
    }
  });
  Recorded run(pipe.file.path, {}, patience);
  for (int i = 0; i < 500; ++i) {
    run.publish();
    run.recorder.step(run.simulation.commands());
  }
  run.recorder.close();
  is_over = true;
  disk.join();
  EXPECT_FALSE(run.recorder.take_failure());
  EXPECT_GT(got.size(), 400'000u);
  EXPECT_TRUE(mcap::check(mcap::bytes_of(got)).faults.empty());
}

/// Ticks that are taken while the disk takes nothing, until the recording is given up.
int ticks_until_failure(int most, std::size_t log, std::chrono::milliseconds between) {
  const Pipe pipe;
  const int other = ::open(pipe.file.path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
  while (::write(other, "x", 1) == 1) {
  }
  Recorded run(pipe.file.path, {}, short_patience);
  ::close(other);
  int taken = 0;
  for (; taken < most && !run.recorder.take_failure(); ++taken) {
    run.publish();
    run.recorder.log(channels::Severity::info, "arm", std::string(log, 'x'));
    run.recorder.step(run.simulation.commands());
    std::this_thread::sleep_for(between);
  }
  return taken;
}

TEST(Recorder, WhatAKilledRunLosesIsBoundedInBytes) {
  const std::size_t log = most_unwritten / 16;
  const auto ticks = ticks_until_failure(200, log, {});
  EXPECT_GT(ticks, 2);
  EXPECT_LE(ticks, 16 + 4);
}

TEST(Recorder, WhatAKilledRunLosesIsBoundedInTime) {
  const auto ticks = ticks_until_failure(100, 0, longest_unwritten / 20);
  EXPECT_GT(ticks, 0);
  EXPECT_LE(ticks, 20 + 2);
}

TEST(Recorder, APipeWithoutAReaderIsReportedAtOnce) {
  Pipe pipe;
  ::close(pipe.reader);
  EXPECT_THROW(Recorded(pipe.file.path), std::runtime_error);
  pipe.reader = -1;
}

TEST(Recorder, APathThatCannotBeWrittenIsReportedAtOnce) {
  EXPECT_THROW(Recorded("/nowhere/at/all.mcap"), std::runtime_error);
}

}  // namespace
}  // namespace ziggurat::recorder
