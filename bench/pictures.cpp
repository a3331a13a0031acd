// SPDX-License-Identifier: MIT
// Time of a picture: a hundred boxes with a tag and an LED each, on a floor, with shadows. Measures
// the processor time of all threads, which other programs affect little, and wall time.

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <string>

#include "render/renderer.h"
#ifndef ONE_AT_A_TIME
#include "render/several.h"
#endif

namespace {

using namespace ziggurat;
using math::Quaternion;
using math::Vector3;

struct World {
  scene::Scene scene;
  std::vector<scene::Entity> entities;
  world::Layout layout;
  world::State state;

  World() {
    scene.physics.floor.emplace();
    scene.arena.size = {4, 4, 1};
    for (int i = 0; i < 100; ++i) add_box({1 + 0.1 * (i / 10), -0.5 + 0.1 * (i % 10), 0}, i);
  }

  void add_box(const Vector3& position, int number) {
    const std::size_t index = entities.size();
    const math::Pose pose{position, Quaternion::Identity()};
    scene::Entity entity;
    scene::Link link;
    link.geometry = scene::Box{{0.055, 0.055, 0.055}};
    entity.links.push_back(link);
    entities.push_back(entity);
    state.origins.push_back(pose);
    state.links.push_back({pose});
    world::TagLayout tag;
    tag.mount = {
        index,
        index,
        {{-0.0275, 0, 0.0275}, Quaternion(Eigen::AngleAxisd(-M_PI / 2, Vector3::UnitY()))}};
    tag.side_length = 0.04;
    layout.tags.push_back(tag);
    state.tag_payloads.push_back(std::to_string(number));
    world::LedLayout led;
    led.mount = {index, index, {{0, 0, 0.055}, Quaternion::Identity()}};
    layout.leds.push_back(led);
    state.led_colors.push_back(0xFF0000);
  }
};

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double wall_ms() {
  return std::chrono::duration<double, std::milli>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

render::View view_of(unsigned width, unsigned height, unsigned oversampling) {
  render::View view =
      render::symmetric_view(render::look_at({0, 0, 0.3}, {1.5, 0, 0}), 0.9, width, height);
  view.oversampling = oversampling;
  return view;
}

void measure(const World& world, unsigned width, unsigned height, unsigned oversampling) {
  render::Renderer renderer(world.scene, world.entities, world.layout);
  const render::View view = view_of(width, height, oversampling);
  render::Picture picture;
  const double begin = processor_ms();
  renderer.draw(world.state, view, picture);
  const double first = processor_ms() - begin;
  constexpr int pictures = 30;
  const double wall = wall_ms();
  for (int i = 0; i < pictures; ++i) renderer.draw(world.state, view, picture);
  const double each = (processor_ms() - begin - first) / pictures;
  fmt::print(
      "{} x {}, oversampling {}: first picture {:.0f} ms, each further one {:.1f} ms of processor "
      "time, "
      "{:.1f} ms of wall time\n",
      width, height, oversampling, first, each, (wall_ms() - wall) / pictures);
}

#ifndef ONE_AT_A_TIME
/// As a film has it made.
void measure_several(const World& world, unsigned threads) {
  render::Several several(world.scene, world.entities, world.layout, threads);
  const render::View view = view_of(640, 480, 2);
  for (unsigned i = 0; i < threads; ++i) several.draw(world.state, {}, view, [](const auto&) {});
  several.finish();
  constexpr int pictures = 60;
  const double wall = wall_ms(), begin = processor_ms();
  for (int i = 0; i < pictures; ++i) several.draw(world.state, {}, view, [](const auto&) {});
  several.finish();
  fmt::print(
      "640 x 480, oversampling 2, {} at a time: each {:.1f} ms of processor time, {:.1f} ms of "
      "wall "
      "time\n",
      threads, (processor_ms() - begin) / pictures, (wall_ms() - wall) / pictures);
}
#endif

}  // namespace

/// @param arguments  the number of pictures: of 640 x 480 only, for a profiler
int main(int count, char** arguments) {
  const World world;
  if (count > 1) {
    render::Renderer renderer(world.scene, world.entities, world.layout);
    render::Picture picture;
    const double begin = processor_ms();
    const int pictures = std::stoi(arguments[1]);
    for (int i = 0; i < pictures; ++i) {
      renderer.draw(world.state, view_of(640, 480, count > 2 ? 2 : 1), picture);
    }
    fmt::print("{:.1f} ms\n", (processor_ms() - begin) / pictures);
    return 0;
  }
  for (const unsigned oversampling : {1u, 2u}) {
    measure(world, 320, 240, oversampling);
    measure(world, 640, 480, oversampling);
    measure(world, 1280, 720, oversampling);
  }
#ifndef ONE_AT_A_TIME  // to be compiled with an earlier renderer
  for (const unsigned threads : {1u, 2u, 4u}) measure_several(world, threads);
#endif
}
