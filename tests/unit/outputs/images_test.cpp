// SPDX-License-Identifier: MIT
#include "outputs/images.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "outputs/output_file.h"
#include "temporary_folder.h"

namespace ziggurat::outputs {
namespace {

namespace fs = std::filesystem;

TEST(ImageName, IsSafeAndUnique) {
  EXPECT_EQ(image_name("fb_0", "Front-1", 123), "fb_0.Front-1.000123.png");
  EXPECT_EQ(image_name("../x", "a/b", 0), "%2E%2E%2Fx.a%2Fb.000000.png");
  EXPECT_EQ(image_name("a.b", "c", 1), "a%2Eb.c.000001.png");
  EXPECT_EQ(image_name("a", "b.c", 1), "a.b%2Ec.000001.png");
  EXPECT_EQ(image_name("a%2Eb", "\xC3\xA9", 12345678), "a%252Eb.%C3%A9.12345678.png");
}

class ImagesTest : public testing::Test {
 protected:
  ImagesTest() {
    layout_.robots.resize(2);
    layout_.robots[0].id = "blind";
    layout_.robots[1].id = "r";
    layout_.robots[1].cameras = {0, 2};
    layout_.cameras.resize(2);
    layout_.cameras[1].id = "eye";
    layout_.cameras[1].resolution = {2, 3};
  }

  TemporaryFolder parent_;
  const fs::path folder_ = parent_ / "images";
  world::Layout layout_;
};

TEST_F(ImagesTest, WritesAFilePerPictureAndNoneForEmptyOnes) {
  Images images(folder_ / "deep", layout_);
  world::Observations observations;
  observations.images.push_back({1, {}});
  images.write(observations);
  EXPECT_TRUE(fs::is_empty(folder_ / "deep"));
  observations.tick = 7;
  observations.images[0].rgb.assign(2 * 3 * 3, 200);
  images.write(observations);
  EXPECT_GT(fs::file_size(folder_ / "deep/r.eye.000007.png"), 50u);
}

TEST_F(ImagesTest, NamesThePathThatItCannotWrite) {
  EXPECT_THROW(Images("/dev/null/x", layout_), WriteError);
}

}  // namespace
}  // namespace ziggurat::outputs
