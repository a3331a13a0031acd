// SPDX-License-Identifier: MIT
#include "render/tag36h11.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <gtest/gtest.h>

#include "scene/devices.h"

namespace ziggurat::render {
namespace {

/// A code of the library as rows of modules; the library gives the place of each bit.
std::uint64_t rows(const apriltag_family_t& family, std::uint64_t code) {
  std::uint64_t result = 0;
  for (std::uint32_t i = 0; i < family.nbits; ++i) {
    const std::uint64_t bit = (code >> (family.nbits - 1 - i)) & 1;
    const std::uint32_t row = family.bit_y[i] - 1, column = family.bit_x[i] - 1;
    result |= bit << (35 - (6 * row + column));
  }
  return result;
}

TEST(Tag36h11, EqualsTheTableOfTheLibrary) {
  apriltag_family_t* family = tag36h11_create();
  ASSERT_EQ(family->ncodes, tag36h11_count);
  ASSERT_EQ(family->width_at_border, 8);
  ASSERT_EQ(family->total_width, 10);
  for (std::size_t id = 0; id < tag36h11_count; ++id) {
    EXPECT_EQ(tag36h11_patterns()[id], rows(*family, family->codes[id])) << "id " << id;
  }
  tag36h11_destroy(family);
}

TEST(TagPattern, ExistsForWholeNumbersFrom0To586) {
  EXPECT_EQ(scene::tag_pattern("0"), 0u);
  EXPECT_EQ(scene::tag_pattern("586"), 586u);
  for (const char* other :
       {"587", "-1", "", " 1", "1 ", "1.0", "+1", "0x1", "box", "99999999999999999999"}) {
    EXPECT_EQ(scene::tag_pattern(other), std::nullopt) << other;
  }
}

}  // namespace
}  // namespace ziggurat::render
