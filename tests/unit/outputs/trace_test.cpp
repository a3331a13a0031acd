// SPDX-License-Identifier: MIT
#include "outputs/trace.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <vector>

#include "file_text.h"

namespace ziggurat::outputs {
namespace {

// A box and a robot with two links.
world::Layout make_layout() {
  world::Layout layout;
  layout.entities = {{"box", {0, 1}, false}, {"robot", {1, 2}, true}};
  layout.links = {{"", 0}, {"base", 1}, {"arm", 1}};
  return layout;
}

const world::Layout two = make_layout();

world::State state() {
  world::State state;
  state.origins.resize(2);
  state.links.resize(3);
  return state;
}

TEST(Trace, HasARowPerOriginAndPerListedLink) {
  auto now = state();
  now.tick = 7;
  now.time_ns = 700'000'000;
  now.origins[0].position = {1, 2, 3};
  now.links[2].pose.position = {0, 0, 0.25};
  now.links[2].pose.orientation = {0, 1, 0, 0};
  const auto path = scratch("csv");
  Trace trace(path, two);
  trace.write(now);
  trace.close();
  EXPECT_EQ(text_of(path),
            "tick,time_s,entity,link,x,y,z,qw,qx,qy,qz\n"
            "7,0.7,box,,1,2,3,1,0,0,0\n"
            "7,0.7,robot,,0,0,0,1,0,0,0\n"
            "7,0.7,robot,base,0,0,0,1,0,0,0\n"
            "7,0.7,robot,arm,0,0,0.25,0,1,0,0\n");
}

TEST(Trace, DigitsReadBackToTheSameDouble) {
  const std::vector<double> values{0.1, 1.0 / 3, 5e-324, -1.7976931348623157e308, 0.1 + 0.2, 1e22};
  auto now = state();
  const auto path = scratch("csv");
  Trace trace(path, two);
  for (const double value : values) {
    now.origins[0].position.x() = value;
    trace.write(now);
  }
  trace.close();
  std::istringstream lines(text_of(path));
  std::vector<double> read;
  for (std::string line; std::getline(lines, line);) {
    const auto start = line.find(",box,,");
    if (start != std::string::npos) read.push_back(std::strtod(&line[start + 6], nullptr));
  }
  EXPECT_EQ(read, values);
}

TEST(Trace, FollowsAddedAndRemovedEntitiesAndAReset) {
  world::Layout layout = make_layout();
  world::State now = state();
  const auto path = scratch("csv");
  Trace trace(path, layout);
  const auto write = [&](std::uint64_t tick) {
    now.tick = tick;
    now.origins.resize(layout.entities.size());
    now.links.resize(layout.links.size());
    trace.write(now);
  };
  write(1);
  layout.entities.push_back({"late", {3, 1}, false});
  layout.links.push_back({"", 2});
  now.absent = {true};
  write(2);
  layout = make_layout();
  layout.entities[0].id = "other";
  now = state();
  write(0);
  trace.close();
  std::istringstream lines(text_of(path));
  std::vector<std::string> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(line.substr(0, 14));
  EXPECT_EQ(rows, (std::vector<std::string>{"tick,time_s,en", "1,0,box,,0,0,0", "1,0,robot,,0,0",
                                            "1,0,robot,base", "1,0,robot,arm,", "2,0,robot,,0,0",
                                            "2,0,robot,base", "2,0,robot,arm,", "2,0,late,,0,0,",
                                            "0,0,other,,0,0", "0,0,robot,,0,0", "0,0,robot,base",
                                            "0,0,robot,arm,"}));
}

TEST(Trace, QuotesIdsThatContainCommasOrQuotes) {
  world::Layout odd;
  odd.entities = {{"a,\"b\"", {0, 1}, false}};
  odd.links = {{"", 0}};
  world::State now;
  now.origins.resize(1);
  now.links.resize(1);
  const auto path = scratch("csv");
  Trace trace(path, odd);
  trace.write(now);
  trace.close();
  EXPECT_NE(text_of(path).find("\n0,0,\"a,\"\"b\"\"\",,0,0,0,1,0,0,0\n"), std::string::npos);
}

}  // namespace
}  // namespace ziggurat::outputs
