#pragma once
// Faults of an author, one row each: the part of a scene that is wrong, and what is said of it.
// A part stands on its own line: framework 2, controllers 3, arena 4, engines 5, media 6, rest 7.

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
