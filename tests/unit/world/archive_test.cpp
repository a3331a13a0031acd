// SPDX-License-Identifier: MIT
// States as bytes, of anyone: what is written to files and sent to viewers has the size that its
// camera says.

#include "world/archive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <variant>

#include "words_of.h"
#include "world/layout.h"

namespace ziggurat::world {
namespace {

struct Camera {
  Camera() {
    layout.cameras.resize(1);
    layout.cameras[0].image = true;
    layout.cameras[0].resolution = {4, 2};
    observations.images.push_back({0, {}});
  }
  /// Fault of a picture of so many bytes; empty: none.
  std::string fault_of(std::size_t size) {
    observations.images[0].rgb.assign(size, 7);
    std::vector<std::byte> bytes;
    auto writer = math::Archive::writer(bytes);
    archive(writer, layout, state, observations);
    auto reader = math::Archive::reader(bytes);
    return words_of<math::ArchiveError>([&] { archive(reader, layout, state, observations); });
  }

  Layout layout;
  State state;
  Observations observations;
};

TEST(Archive, TakesPicturesOfTheSizeOfTheirCameraOnly) {
  Camera camera;
  EXPECT_EQ(camera.fault_of(0), "") << "none was taken yet";
  EXPECT_EQ(camera.fault_of(24), "");
  for (const std::size_t size : {1, 23, 25, 4096}) {
    EXPECT_NE(camera.fault_of(size).find("another size than its camera"), std::string::npos)
        << size;
  }
}

TEST(Archive, GivesBackTheImageThatLiesOnAFloor) {
  const Layout layout;
  State state;
  FloorPaint laid{{1, 2}, {3, 4}};
  laid.image = std::get<0>(floor_image("P5 1 1 255\nx"));
  state.floor = {laid};
  std::vector<std::byte> bytes;
  auto writer = math::Archive::writer(bytes);
  archive(writer, layout, state);

  State read;
  auto reader = math::Archive::reader(bytes);
  archive(reader, layout, read);
  ASSERT_EQ(read.floor.size(), 1u);
  EXPECT_EQ(read.floor[0].half_size, laid.half_size);
  EXPECT_EQ(read.floor[0].image->file, laid.image->file);
  EXPECT_EQ(hash(read, {}), hash(state, {}));
  EXPECT_NE(hash(read, {}), hash(State{}, {}));

  std::ranges::replace(bytes, std::byte{'P'}, std::byte{'Q'});
  auto damaged = math::Archive::reader(bytes);
  EXPECT_NE(
      words_of<math::ArchiveError>([&] { archive(damaged, layout, read); }).find("is no image"),
      std::string::npos);
}

}  // namespace
}  // namespace ziggurat::world
