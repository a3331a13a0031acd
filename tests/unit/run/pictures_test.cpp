// SPDX-License-Identifier: MIT
#include "run/pictures.h"

#include <gtest/gtest.h>

#include "run/loading.h"
#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::run {
namespace {

TEST(TickAt, IsTheTickThatATimeFallsInto) {
  scene::Experiment experiment;
  experiment.ticks_per_second = 100;
  EXPECT_EQ(tick_at(0, experiment), 0u);
  EXPECT_EQ(tick_at(0.29, experiment), 29u);  // the product is 28.999999999999996
  EXPECT_EQ(tick_at(0.299, experiment), 29u);
  EXPECT_EQ(tick_at(1e30, experiment), std::uint64_t{1} << 63);
  PictureOptions options;
  options.out = "a.png";
  options.times = {1, 3, 2};
  EXPECT_EQ(last_tick(options, experiment), 300u);
}

TEST(LastTick, OfAFilmIsThatOfItsLastFrame) {
  scene::Experiment experiment;
  experiment.ticks_per_second = 100;
  PictureOptions options;
  options.film.emplace();
  options.film->from = 1;
  EXPECT_THROW(last_tick(options, experiment), text::UsageError) << "it has no end";
  experiment.length = 3;
  options.film->frames_per_second = 10;
  EXPECT_EQ(last_tick(options, experiment), 290u);  // 20 frames, the first at 1 s
  options.film->to = 2;
  EXPECT_EQ(last_tick(options, experiment), 190u);
  options.film->speed = 2;
  EXPECT_EQ(last_tick(options, experiment), 180u);  // 5 frames
  options.out = "a.png";
  options.times = {4};
  EXPECT_EQ(last_tick(options, experiment), 400u);
}

TEST(PicturePath, IsTheNameItselfForOnePicture) {
  EXPECT_EQ(picture_path("a/b.png", 0, 1), "a/b.png");
  EXPECT_EQ(picture_path("b", 0, 1), "b");
}

TEST(PicturePath, HasOnePlaceForANumberAndNoOtherDirection) {
  const auto complaint = [](const std::string& out) -> std::string {
    return words_of<text::UsageError>([&] { check_picture_path(out); });
  };
  for (const char* good : {"", "a.png", "%d.png", "f%03d.png", "100%/f%02d.png", "50%.png",
                           "50% off.png", "%%.png", "%"}) {
    EXPECT_EQ(complaint(good), "") << good;
  }
  EXPECT_EQ(complaint("%03d_%03d.png"),
            "--out is '%03d_%03d.png': '%03d' stands behind another place for a number; write %03d "
            "once, for the number of the "
            "picture");
  EXPECT_EQ(complaint("f%s.png"),
            "--out is 'f%s.png': '%s' is no place for a number; write %03d once, for the number of "
            "the picture");
  for (const char* bad : {"%-3d.png", "%03i.png", "%x%d.png", "f%99999999999999999999d.png"}) {
    EXPECT_NE(complaint(bad), "") << bad;
  }
}

TEST(PicturePath, NumbersSeveral) {
  EXPECT_EQ(picture_path("a/b.png", 7, 8), "a/b_007.png");
  EXPECT_EQ(picture_path("b", 1234, 2000), "b_1234");
  EXPECT_EQ(picture_path("f%03d.png", 7, 8), "f007.png");
  EXPECT_EQ(picture_path("f%d.png", 7, 8), "f7.png");
  EXPECT_EQ(picture_path("100%/f%02d.png", 7, 8), "100%/f07.png");
  EXPECT_EQ(picture_path("%d", 7, 1), "7");
  EXPECT_EQ(picture_path("f%s.png", 7, 8), "f%s_007.png");
  EXPECT_EQ(picture_path("f%99999999999999999999d.png", 7, 8), "f%99999999999999999999d_007.png");
}

}  // namespace
}  // namespace ziggurat::run
