// SPDX-License-Identifier: MIT
#include "supervision/snapshots.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <variant>

#include "scene/reader.h"

namespace ziggurat::supervision {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<World> falling_box() {
  auto read = scene::read_text(
      R"(<argos><framework><experiment ticks_per_second="10" random_seed="1"/></framework>)"
      R"(<controllers/><arena size="9,9,9"><box id="box" size="1,1,1" movable="true" mass="1">)"
      R"(<body position="0,0,2"/></box></arena><physics_engines><dynamics3d id="d"/>)"
      R"(</physics_engines><media/></argos>)",
      "box.argos");
  for (const auto& problem : read.problems) ADD_FAILURE() << scene::to_string(problem);
  return std::make_unique<World>(
      "box.argos", scene::OpenScene{std::move(read.scene), std::move(read.additions)}, 1);
}

scene::OpenFile no_files() {
  return [](const fs::path&, std::size_t) -> std::variant<scene::File, std::string> {
    return "there are no files";
  };
}

class OfSnapshots : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directory(folder); }
  void TearDown() override { fs::remove_all(folder); }
  bool has(const Snapshots& snapshots, const std::string& name) const {
    return std::holds_alternative<FoundSnapshot>(snapshots.find(name, *world, no_files()));
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }

  const fs::path folder =
      fs::path(::testing::TempDir()) / ("snapshots-" + std::to_string(getpid()));
  const std::unique_ptr<World> world = falling_box();
};

TEST_F(OfSnapshots, NamesAreNoPaths) {
  Snapshots snapshots(folder, "build");
  for (const std::string name :
       {"", ".", "..", ".x", "../x", "a/b", "/etc/x", "a b", "\xc3\xa4", "a\n"}) {
    const auto fault = snapshots.keep(name, *world);
    ASSERT_TRUE(fault) << name;
    EXPECT_EQ(fault->code, wire::ErrorCode::bad_value);
    EXPECT_FALSE(has(snapshots, name)) << name;
  }
  EXPECT_TRUE(snapshots.keep(std::string("a\0b", 3), *world));
  EXPECT_TRUE(snapshots.keep(std::string(65, 'x'), *world));
  EXPECT_EQ(files(), 0U);
  EXPECT_FALSE(snapshots.keep(std::string(64, 'x'), *world));
  EXPECT_EQ(files(), 1U);
}

TEST_F(OfSnapshots, AnotherServerFindsThemInTheFolder) {
  for (int i = 0; i < 3; ++i) world->simulation.step();
  const std::uint64_t hash = world->simulation.hash();
  ASSERT_FALSE(Snapshots(folder, "build").keep("here", *world));
  world->simulation.step();
  const Snapshots later(folder, "build");
  const auto found = later.find("here", *world, no_files());
  ASSERT_TRUE(std::holds_alternative<FoundSnapshot>(found));
  world->restore(std::get<FoundSnapshot>(found).snapshot);
  EXPECT_EQ(world->simulation.hash(), hash);
  EXPECT_EQ(world->simulation.state().tick, 3U);
  EXPECT_FALSE(has(Snapshots({}, "build"), "here"));
  EXPECT_FALSE(has(Snapshots(folder, "another build"), "here"));
}

TEST_F(OfSnapshots, ADamagedFileIsRefused) {
  ASSERT_FALSE(Snapshots(folder, "build").keep("here", *world));
  const fs::path file = folder / "here.snapshot";
  ASSERT_TRUE(has(Snapshots(folder, "build"), "here"));
  fs::resize_file(file, fs::file_size(file) - 1);
  const auto found = Snapshots(folder, "build").find("here", *world, no_files());
  ASSERT_TRUE(std::holds_alternative<wire::Fault>(found));
  EXPECT_EQ(std::get<wire::Fault>(found).message,
            "'here.snapshot': The snapshot is damaged: its checksum is wrong.");
  fs::resize_file(file, 0);
  EXPECT_FALSE(has(Snapshots(folder, "build"), "here"));
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_FALSE(has(Snapshots(folder, "build"), "here"));
}

TEST_F(OfSnapshots, LinksInTheFolderAreNotWrittenThrough) {
  const fs::path other = folder / "other";
  std::ofstream(other) << "kept";
  for (const char* planted : {"here.snapshot", "here.snapshot.part"})
    fs::create_symlink(other, folder / planted);
  ASSERT_FALSE(Snapshots(folder, "build").keep("here", *world));
  EXPECT_EQ(fs::file_size(other), 4U);
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder / "here.snapshot")));
  EXPECT_TRUE(has(Snapshots(folder, "build"), "here"));
}

TEST_F(OfSnapshots, AFolderThatIsGoneIsAnErrorAndNothingIsKept) {
  Snapshots snapshots(folder, "build");
  fs::remove_all(folder);
  const auto fault = snapshots.keep("here", *world);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->code, wire::ErrorCode::out_of_state);
  EXPECT_FALSE(has(snapshots, "here"));
  EXPECT_THROW(Snapshots(folder, "build"), std::runtime_error);
}

TEST_F(OfSnapshots, TheirNumberIsLimited) {
  Snapshots snapshots({}, "build");
  for (int i = 0; i < 1024; ++i) ASSERT_FALSE(snapshots.keep(std::to_string(i), *world));
  const auto fault = snapshots.keep("more", *world);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->code, wire::ErrorCode::too_many);
  EXPECT_FALSE(snapshots.keep("7", *world));  // the name is used again
}

}  // namespace
}  // namespace ziggurat::supervision
