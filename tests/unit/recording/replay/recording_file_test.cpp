// SPDX-License-Identifier: MIT
// Recordings on disk, made by the writer of MCAP files.

#include "recording/replay/recording_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "recorded_run.h"
#include "recording/mcap/writer.h"
#include "recording/replay/difference.h"
#include "recording/replay/export.h"
#include "recording/replay/names.h"
#include "temporary_folder.h"
#include "words_of.h"
#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::replay {
namespace {

using testing::eventful_run;
using testing::OwnWorld;
using testing::Recording;

/// A file in a folder of its own.
class Disk : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ / name; }

  /// @param size   of the file's bytes that are written; -1: all
  /// @param topic  of the inputs
  std::string write(const Recording& recording, long size = -1,
                    const char* topic = "/inputs") const {
    std::string bytes;
    mcap::Writer writer([&](std::string_view more) { bytes += more; }, {"ziggurat", "test"},
                        mcap::Compression::zstd);
    const auto channel = [&](const char* name, const char* type) {
      return writer.add_channel(writer.add_schema(type, "protobuf", "x"), name, "protobuf");
    };
    const auto run = channel("/run", "ziggurat.v1.RunStart");
    const auto inputs = channel(topic, "ziggurat.v1.Inputs");
    const auto state = channel("/state", "ziggurat.v1.ExactState");
    const EmbeddedFiles files = testing::files();
    for (const char* name : {"scenes/small.argos", "scenes/models/arm.xml"}) {
      writer.attach(name, "text/xml", *files.find(name), 0, 0);
    }
    writer.write(run, 0, 0, testing::start().SerializeAsString());
    recording::StatePacker packer;
    for (std::size_t i = 0; i < recording.inputs.size(); ++i) {
      world::State links;
      links.tick = recording.inputs[i].tick();
      links.links = recording.links[i];
      v1::ExactState exact;
      if (i % 8 == 0) packer = {};  // a complete state
      packer.pack(recording.inputs[i].epoch(), links, exact);
      writer.write(state, i, i, exact.SerializeAsString());
      writer.write(inputs, i, i, recording.inputs[i].SerializeAsString());
      if (i % 8 == 7) writer.end_chunk();
    }
    writer.close();
    std::ofstream file(path("run.mcap"), std::ios::binary);
    file.write(bytes.data(), size < 0 ? static_cast<long>(bytes.size()) : size);
    return path("run.mcap");
  }

  TemporaryFolder folder_;
};

std::size_t same_states(const RecordingFile& file) {
  OwnWorld own;
  own.opened = read_scene(file.run(), file.files());
  simulation::Simulation simulation(own.opened.scene, {file.run().seed(), {}});
  States states(file);
  Replay replay({own.opened.scene, own.opened.additions, simulation, own.seed},
                file.files().opener(), [&] { return states.next(); });
  std::size_t count = 0;
  while (replay.advance() && replay.is_same()) {
    EXPECT_NE(states.links(), nullptr);
    if (!states.links()) break;
    EXPECT_FALSE(first_difference(*states.links(), simulation.state().links));
    ++count;
  }
  return count;
}

TEST_F(Disk, ARecordingIsRepeatedFromItsFile) {
  const Recording recording = eventful_run();
  const RecordingFile file(write(recording));
  EXPECT_EQ(file.shortcoming(), "");
  EXPECT_EQ(file.states(), recording.inputs.size());
  EXPECT_EQ(same_states(file), recording.inputs.size());
}

TEST_F(Disk, WhatAKilledRunLeavesIsRepeated) {
  const Recording recording = eventful_run();
  const std::string path = write(recording);
  const auto size = static_cast<long>(std::filesystem::file_size(path));
  const RecordingFile whole(path);
  const auto& chunks = whole.reader().contents().chunks;
  ASSERT_GE(chunks.size(), 3u);
  write(recording, static_cast<long>(chunks[1].offset + chunks[1].length) + 5);
  ASSERT_LT(static_cast<long>(std::filesystem::file_size(path)), size);
  const RecordingFile cut(path);
  EXPECT_NE(cut.shortcoming(), "");
  EXPECT_EQ(same_states(cut), 16u);
}

TEST_F(Disk, OneThatIsCutBeforeItsFirstMessageSaysSo) {
  const std::string path = write(eventful_run());
  const RecordingFile whole(path);
  const auto first = static_cast<long>(whole.reader().contents().chunks.front().offset);
  write(eventful_run(), first + 5);
  EXPECT_TRUE(
      fails_with<RecordingError>("its end is missing", [&] { const RecordingFile cut(path); }));
}

TEST_F(Disk, ADamagedPlaceIsNamed) {
  const std::string path = write(eventful_run());
  const std::uint64_t place = RecordingFile(path).reader().contents().chunks[1].offset + 60;
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<long>(place));
  file.put('\x55').put('\xAA').put('\x55');
  file.close();
  const RecordingFile damaged(path);
  States states(damaged);
  int count = 0;
  EXPECT_TRUE(fails_with<RecordingError>("damaged at byte", [&] {
    while (states.next()) ++count;
  }));
  EXPECT_EQ(count, 8);
}

TEST_F(Disk, OtherFilesAreRefused) {
  std::ofstream(path("scene.argos")) << "<argos/>";
  EXPECT_THROW(RecordingFile(path("scene.argos")), RecordingError);
  EXPECT_THROW(RecordingFile(path("nothing.mcap")), std::runtime_error);
  std::string bytes;
  mcap::Writer writer([&](std::string_view more) { bytes += more; }, {"other", "test"},
                      mcap::Compression::none);
  writer.close();
  std::ofstream(path("other.mcap"), std::ios::binary) << bytes;
  EXPECT_THROW(RecordingFile(path("other.mcap")), RecordingError);
}

/// A recording in memory with one message of each of these topics.
struct Topic {
  const char* name;
  const char* type;
  std::string bytes;
};
std::string recording_of(const std::vector<Topic>& topics) {
  std::string bytes;
  mcap::Writer writer([&](std::string_view more) { bytes += more; }, {"ziggurat", "test"},
                      mcap::Compression::zstd);
  const auto add = [&](const Topic& topic) {
    const auto schema = writer.add_schema(topic.type, "protobuf", "x");
    writer.write(writer.add_channel(schema, topic.name, "protobuf"), 0, 0, topic.bytes);
  };
  add({"/run", "ziggurat.v1.RunStart", testing::start().SerializeAsString()});
  for (const Topic& topic : topics) add(topic);
  writer.close();
  return bytes;
}

std::string repeated(std::string_view piece, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += piece;
  return all;
}

/// Sentence of the fault; empty: there was none.
std::string fault_of(const std::function<void()>& read) { return words_of<RecordingError>(read); }

TEST_F(Disk, NamesLinksOfEntitiesThatAreNotThere) {
  v1::World message;
  message.add_entities()->set_id("box");
  for (const std::uint32_t entity : {0U, 1U, 0x80000000U, 0xffffffffU})
    message.add_links()->set_entity(entity);
  const std::string bytes =
      recording_of({{"/world", "ziggurat.v1.World", message.SerializeAsString()}});
  const RecordingFile file("hostile", mcap::bytes_of(bytes));
  EXPECT_EQ(link_names(file), (std::vector<std::string>{"'box'", "'?'", "'?'", "'?'"}));
}

TEST_F(Disk, NamesThatEachLinkRepeatsAreBounded) {
  v1::World message;
  message.add_entities()->set_id(std::string(1'000'000, 'x'));
  message.mutable_entities(0)->set_link_count(1000);
  for (int i = 0; i < 1000; ++i) message.add_links();
  const std::string bytes =
      recording_of({{"/world", "ziggurat.v1.World", message.SerializeAsString()},
                    {"/state", "ziggurat.v1.ExactState", {}}});
  const RecordingFile file("hostile", mcap::bytes_of(bytes));
  EXPECT_NE(fault_of([&] { link_names(file); }).find("the names of its links have"),
            std::string::npos);
  EXPECT_NE(
      fault_of([&] { export_csv(file, path("out.csv")); }).find("the names of its links have"),
      std::string::npos);
}

TEST_F(Disk, LinksOfAnotherEntityAreNoRowsOfATable) {
  v1::World message;
  for (int i = 0; i < 2; ++i) message.add_entities()->set_link_count(2);
  for (int i = 0; i < 2; ++i) message.add_links();
  const std::string bytes =
      recording_of({{"/world", "ziggurat.v1.World", message.SerializeAsString()},
                    {"/state", "ziggurat.v1.ExactState", {}}});
  const RecordingFile file("hostile", mcap::bytes_of(bytes));
  EXPECT_NE(fault_of([&] { export_csv(file, path("out.csv")); }).find("not its own"),
            std::string::npos);
}

TEST_F(Disk, ATableWithoutAnyStateIsAFault) {
  v1::World message;
  message.add_entities()->set_link_count(1);
  message.add_links();
  const std::string world = message.SerializeAsString();
  const std::string bytes = recording_of(
      {{"/world", "ziggurat.v1.World", world}, {"/state", "ziggurat.v1.ExactState", {}}});
  const RecordingFile file("cut.mcap", mcap::bytes_of(bytes));
  EXPECT_EQ(fault_of([&] { export_csv(file, path("out.csv")); }),
            "cut.mcap: no state of it is intact, so a table would be empty");
}

TEST_F(Disk, AMessageOfManySmallPartsIsToldAndNotDecoded) {
  const std::string world = repeated({"\x62\0", 2}, 40'000'000);  // entities
  const std::string bytes =
      recording_of({{"/world", "ziggurat.v1.World", world},
                    {"/state", "ziggurat.v1.ExactState", {}},
                    {"/inputs", "ziggurat.v1.Inputs", repeated("\x22\x02\x3a\x00", 1)}});
  const RecordingFile file("hostile.mcap", mcap::bytes_of(bytes));
  const std::function<void()> readers[] = {
      [&] { link_names(file); }, [&] { export_csv(file, path("out.csv")); },
      [&] {
        export_jsonl(
            file, [](const auto&) { return true; }, path("out.jsonl"));
      }};
  for (const auto& read : readers) {
    const std::string told = fault_of(read);
    EXPECT_TRUE(told.starts_with("hostile.mcap: a message of /world at 0 s, in the chunk at byte "))
        << told;
    EXPECT_NE(told.find("take another copy of the recording"), std::string::npos) << told;
  }
}

TEST_F(Disk, InputsAndStatesOfManySmallPartsAreToldAndNotDecoded) {
  const Topic topics[] = {
      {"/inputs", "ziggurat.v1.Inputs", repeated({"\x22\x02\x3a\0", 4}, 8'000'000)},
      {"/state", "ziggurat.v1.ExactState", repeated({"\x7a\0", 2}, 15'000'000)},
      {"/state", "ziggurat.v1.ExactState", std::string(33'554'433, '\0')}};
  for (const Topic& topic : topics) {
    const std::string bytes = recording_of({topic, {"/inputs", "ziggurat.v1.Inputs", {}}});
    const RecordingFile file("hostile.mcap", mcap::bytes_of(bytes));
    States states(file);
    const std::string told = fault_of([&] { states.next(); });
    EXPECT_NE(told.find(topic.name), std::string::npos) << told;
  }
}

TEST_F(Disk, ARunThatIsTooLargeIsToldAndNotDecoded) {
  std::string bytes;
  mcap::Writer writer([&](std::string_view more) { bytes += more; }, {"ziggurat", "test"},
                      mcap::Compression::zstd);
  const auto schema = writer.add_schema("ziggurat.v1.RunStart", "protobuf", "x");
  writer.write(writer.add_channel(schema, "/run", "protobuf"), 0, 0,
               repeated({"\x3a\0", 2}, 20'000'000));
  writer.close();
  EXPECT_NE(fault_of([&] {
              const RecordingFile file("hostile.mcap", mcap::bytes_of(bytes));
            }).find("/run"),
            std::string::npos);
}

/// Later rows must not refer to entities that a smaller world lacks.
TEST_F(Disk, ASmallerWorldHasRowsOfItsOwn) {
  std::string bytes;
  mcap::Writer writer([&](std::string_view more) { bytes += more; }, {"ziggurat", "test"},
                      mcap::Compression::none);
  const auto channel = [&](const char* topic, const char* type) {
    return writer.add_channel(writer.add_schema(type, "protobuf", "x"), topic, "protobuf");
  };
  const auto run = channel("/run", "ziggurat.v1.RunStart"),
             world = channel("/world", "ziggurat.v1.World"),
             state = channel("/state", "ziggurat.v1.ExactState");
  writer.write(run, 0, 0, testing::start().SerializeAsString());
  for (std::uint64_t tick = 0; tick < 2; ++tick) {
    const std::uint32_t count = tick == 0 ? 1000 : 1;
    v1::World message;
    v1::ExactState exact;
    for (std::uint32_t i = 0; i < count; ++i) {
      auto& entity = *message.add_entities();
      entity.set_id("of" + std::to_string(tick));
      entity.set_kind(v1::World::Entity::BOX);
      entity.set_first_link(i);
      entity.set_reference_link(i);
      entity.set_link_count(1);
      message.add_links()->set_entity(i);
      for (int k = 0; k < 13; ++k) exact.add_values(k);
    }
    exact.set_tick(tick);
    exact.set_is_complete(true);
    writer.write(world, tick, tick, message.SerializeAsString());
    writer.write(state, tick, tick, exact.SerializeAsString());
  }
  writer.close();
  const RecordingFile file("hostile", mcap::bytes_of(bytes));
  EXPECT_EQ(export_csv(file, path("out.csv")), 2u);
  std::ifstream lines(path("out.csv"));
  std::string line, last;
  int count = 0;
  for (; std::getline(lines, line); ++count) last = line;
  EXPECT_EQ(count, 1 + 1000 + 1);
  EXPECT_TRUE(last.starts_with("1,")) << last;
  EXPECT_NE(last.find(",of1,"), std::string::npos) << last;
}

TEST_F(Disk, MessagesBecomeLines) {
  const Recording recording = eventful_run();
  const RecordingFile file(write(recording));
  const auto is_inputs = [](const std::string& topic) { return topic == "/inputs"; };
  EXPECT_EQ(export_jsonl(file, is_inputs, path("out.jsonl")), recording.inputs.size());
  std::ifstream lines(path("out.jsonl"));
  std::string first;
  std::getline(lines, first);
  EXPECT_TRUE(
      first.starts_with(R"({"topic":"/inputs","time_s":0,"message":{"epoch":"0","tick":"0")"))
      << first;
  EXPECT_THROW(export_jsonl(
                   file, [](const auto&) { return false; }, path("out.jsonl")),
               RecordingError);
  EXPECT_THROW(export_csv(file, path("out.csv")), RecordingError) << "it has no /world";
}

TEST_F(Disk, ATopicThatIsNoUtf8IsExportedAsOneThatIs) {
  const RecordingFile file(write(eventful_run(), -1, "/inputs\xff"));
  const auto is_first = [](const std::string& topic) { return topic.starts_with("/inputs"); };
  EXPECT_GT(export_jsonl(file, is_first, path("out.jsonl")), 0u);
  std::ifstream lines(path("out.jsonl"));
  std::string first;
  std::getline(lines, first);
  EXPECT_TRUE(first.starts_with("{\"topic\":\"/inputs\xef\xbf\xbd\",")) << first;
}

}  // namespace
}  // namespace ziggurat::replay
