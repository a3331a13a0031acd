// SPDX-License-Identifier: MIT
#include "run/radio_watch.h"

#include <gtest/gtest.h>

#include <array>

namespace ziggurat::run {
namespace {

/// Robots "a" and "b" with a radio each, of one medium.
struct Two {
  Two() {
    layout.entities.resize(2);
    layout.entities[0].id = "a";
    layout.entities[1].id = "b";
    layout.radios.resize(2);
    for (std::size_t r = 0; r < 2; ++r) {
      layout.radios[r].id = "r";
      layout.radios[r].mount.entity = r;
      layout.radios[r].sends = layout.radios[r].receives = true;
    }
  }
  /// @param sending  radios that send;  @param hearing  radios that receive
  void tick(const std::vector<std::size_t>& sending, const std::vector<std::size_t>& hearing = {}) {
    constexpr std::array<std::uint8_t, 1> byte{1};
    world::Commands commands;
    world::Observations observations;
    for (const std::size_t radio : sending) {
      commands.radio_messages.add(radio, byte);
      commands.radio_messages.add(radio, byte);
    }
    for (const std::size_t radio : hearing) observations.radio_messages.add(radio, byte);
    watch.tick(observations, commands);
  }
  world::Layout layout;
  RadioWatch watch;
};

TEST(RadioWatch, TellsOfRadiosThatNeverFellSilent) {
  Two two;
  for (int i = 0; i < 20; ++i) two.tick({0, 1});
  EXPECT_EQ(two.watch.warning(two.layout)
                .find("radio 'r' of 'a' and 1 more sent at every tick and so heard nothing"),
            0u)
      << two.watch.warning(two.layout);
}

TEST(RadioWatch, TellsOfMessagesThatWereTooMany) {
  Two two;
  world::Observations observations;
  two.watch.tick(observations, {});
  for (const std::uint64_t left_out : {5, 0, 7}) {
    observations.tick += 1;
    observations.radio_messages.left_out = left_out;
    two.watch.tick(observations, {});
  }
  EXPECT_EQ(two.watch.warning(two.layout)
                .find("from tick 1 on, 12 radio messages were not received: all radios together"),
            0u)
      << two.watch.warning(two.layout);
}

TEST(RadioWatch, IsQuietAboutOthers) {
  Two alone;
  for (int i = 0; i < 20; ++i) alone.tick({0});
  EXPECT_EQ(alone.watch.warning(alone.layout), "") << "there was nothing to hear";
  Two pauses;
  for (int i = 0; i < 20; ++i)
    pauses.tick(i % 4 == 0 ? std::vector<std::size_t>{} : std::vector<std::size_t>{0, 1});
  EXPECT_EQ(pauses.watch.warning(pauses.layout), "");
  Two hears;
  for (int i = 0; i < 20; ++i) hears.tick({0, 1}, {0, 1});
  EXPECT_EQ(hears.watch.warning(hears.layout), "");
  Two deaf;
  deaf.layout.radios[0].receives = deaf.layout.radios[1].receives = false;
  for (int i = 0; i < 20; ++i) deaf.tick({0, 1});
  EXPECT_EQ(deaf.watch.warning(deaf.layout), "");
}

}  // namespace
}  // namespace ziggurat::run
