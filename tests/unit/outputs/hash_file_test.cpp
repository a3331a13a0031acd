// SPDX-License-Identifier: MIT
#include "outputs/hash_file.h"

#include <gtest/gtest.h>

#include "file_text.h"

namespace ziggurat::outputs {
namespace {

TEST(HashFile, HasALinePerTick) {
  const auto path = scratch("hashes");
  HashFile file(path);
  file.write(0, 0xABCDEF);
  file.write(1, ~std::uint64_t{0});
  file.close();
  EXPECT_EQ(text_of(path), "hash 0 0000000000abcdef\nhash 1 ffffffffffffffff\n");
}

}  // namespace
}  // namespace ziggurat::outputs
