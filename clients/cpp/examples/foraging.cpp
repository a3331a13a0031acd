// SPDX-License-Identifier: MIT
// Foraging with items that respawn: a director with the rule of scenes/experiments/foraging.lua.
//   ziggurat serve scenes/experiments/foraging.argos --endpoint tcp://127.0.0.1:7400
//   ziggurat-lua --connect tcp://127.0.0.1:7400                                       the robots
//   ZIGGURAT_ENDPOINT=tcp://127.0.0.1:7400 ZIGGURAT_DIRECTOR=food example_foraging    the food
// With command="example_foraging" in place of script="foraging.lua" in the scene, `ziggurat run`
// starts it.

#include <ziggurat/ziggurat.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr double reach = 0.25;       // a robot collects what is nearer to its centre [m]
constexpr double clear = 0.5;        // food appears no nearer to a robot [m]
constexpr double half = 1.6;         // of the area where food appears [m]
constexpr std::uint64_t pause = 20;  // ticks until something new appears

struct Place {
  double x, y;  // [m]
};

struct Food {
  std::mt19937_64 random;             // of the run's seed: the same run again has the same places
  std::vector<std::uint64_t> due;     // ticks at which something new appears
  std::vector<std::string> expected;  // ids of what was placed last
  int placed = 0;
  int collected = 0;
};

int param(const ziggurat::Director& director, const char* name) {
  for (const auto& [key, value] : director.params()) {
    if (key == name) return std::stoi(value);
  }
  throw std::runtime_error(std::string("the scene has no parameter ") + name);
}

Food begin(const ziggurat::Director& director) {
  Food food;
  food.random.seed(director.seed());
  food.due.assign(param(director, "items"), 1);
  return food;
}

double distance(const ziggurat::Entity& entity, const Place& place) {
  const auto& position = entity.pose().position;
  return std::hypot(position[0] - place.x, position[1] - place.y);
}

/// The first robot that is nearer to the place; null if none is.
const ziggurat::Entity* find_robot(const ziggurat::Director& director, const Place& place,
                                   double radius) {
  for (const ziggurat::Entity* entity : director.entities()) {
    if (entity->kind() == "foot-bot" && distance(*entity, place) < radius) return entity;
  }
  return nullptr;
}

/// From -half to half. Distributions of the standard library differ from one to another.
double coordinate(std::mt19937_64& random) {
  return half * (0x1p-52 * static_cast<double>(random() >> 11) - 1);
}

/// Somewhere, but not beside a robot.
std::optional<Place> find_free_place(const ziggurat::Director& director, Food& food) {
  for (int trial = 0; trial < 100; ++trial) {
    Place place{};
    place.x = coordinate(food.random);
    place.y = coordinate(food.random);
    if (!find_robot(director, place, clear)) return place;
  }
  return std::nullopt;
}

bool place_item(ziggurat::Director& director, Food& food) {
  const auto place = find_free_place(director, food);
  if (!place) return false;
  const std::string id = "food" + std::to_string(++food.placed);
  char element[200];
  std::snprintf(
      element, sizeof element,
      R"(<cylinder id="%s" radius="0.05" height="0.1" movable="false"><body position="%.4f,%.4f,0"/></cylinder>)",
      id.c_str(), place->x, place->y);
  director.spawn(element);
  food.expected.push_back(id);
  return true;
}

/// Before the next tick.
void place_due(ziggurat::Director& director, Food& food) {
  std::vector<std::uint64_t> later;
  for (const std::uint64_t at : food.due) {
    if (at > director.tick() + 1 || !place_item(director, food)) later.push_back(at);
  }
  food.due = later;
}

/// After a tick.
void collect(ziggurat::Director& director, Food& food) {
  for (const std::string& id :
       food.expected) {  // what could not be placed, because something stands there
    if (!director.find(id)) food.due.push_back(director.tick());
  }
  food.expected.clear();
  for (const ziggurat::Entity* item : director.entities()) {
    if (item->kind() != "cylinder") continue;
    const auto& position = item->pose().position;
    const ziggurat::Entity* robot = find_robot(director, {position[0], position[1]}, reach);
    if (!robot) continue;
    director.remove(item->id());
    food.due.push_back(director.tick() + pause);
    ++food.collected;
    director.log(robot->id() + " collects " + item->id() + ": " + std::to_string(food.collected));
  }
  director.metric("collected", food.collected);
}

}  // namespace

int main() try {
  using Event = ziggurat::Event;
  ziggurat::Director director(ziggurat::DirectorOptions::from_environment());
  Food food;
  while (director.next()) {
    if (director.event() == Event::init || director.event() == Event::reset) {
      food = begin(director);
    } else {
      collect(director, food);
    }
    if (food.collected >= param(director, "goal")) director.finish();
    place_due(director, food);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "foraging: %s\n", error.what());
  return 1;
}
