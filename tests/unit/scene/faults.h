// SPDX-License-Identifier: MIT
#pragma once
// Faults of authors, one row each: the wrong part of a scene, and the expected message.
// A part is on its own line: framework 2, controllers 3, arena 4, engines 5, media 6, rest 7.

#include <gtest/gtest.h>

#include <ostream>

namespace ziggurat::scene {

enum class Part {
  framework,
  controllers,
  arena,
  entity,
  link,
  loose_link,
  joint,
  device,
  engines,
  media,
  rest
};

struct Row {
  const char* name;
  Part part;
  const char* text;
  const char* expected;  ///< part of the first fault
};

inline std::ostream& operator<<(std::ostream& out, const Row& row) { return out << row.name; }

class Fault : public testing::TestWithParam<Row> {};

}  // namespace ziggurat::scene
