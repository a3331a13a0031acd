// Time per tick of cameras in a 10 m arena, without and with many devices far away.
//
// usage: bench_cameras
//
// 64 robots on a lattice of 1.25 m, each with a camera that looks at five boxes with a tag and six
// LEDs each: 320 tags and 1 920 LEDs in view. The arena contains 180 more tags and 80 more LEDs.
// The second run adds 5 000 boxes with a tag each at 20 to 60 m, ten times as many tags as before.

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "devices/kind.h"
#include "scene/reader.h"
#include "simulation/layout.h"
#include "simulation/placement.h"

namespace ziggurat::devices {
std::unique_ptr<Kind> make_cameras();  // camera.cpp
}

namespace {

using namespace ziggurat;

std::string body(const std::string& id, double x, double y, double size, const std::string& more) {
  return fmt::format(
      R"(<prototype id="{}" movable="false"><body position="{},{},0"/><links ref="b">)"
      R"(<link id="b" geometry="box" size="{},{},{}" mass="1"/></links>{}</prototype>)",
      id, x, y, size, size, size, more);
}

std::string tag_and_leds(int leds) {
  std::string text =
      R"(<devices><tags medium="tags"><tag anchor="b" side_length="0.02" observable_angle="75" )"
      R"(position="-0.021,0,0.02" orientation="0,-90,0"/></tags>)";
  if (leds > 0) text += R"(<leds medium="leds">)";
  for (int i = 0; i < leds; ++i) {
    text += fmt::format(R"(<led anchor="b" color="red" offset="-0.021,{},{}"/>)",
                        i % 2 ? 0.015 : -0.015, 0.005 + 0.012 * (i / 2));
  }
  return text + (leds > 0 ? "</leds></devices>" : "</devices>");
}

std::string arena(int far_tags) {
  std::string text;
  for (int i = 0; i < 64; ++i) {
    const double x = 1.25 * (i % 8) - 4.7, y = 1.25 * (i / 8) - 4.375;
    text += body(fmt::format("robot{}", i), x, y, 0.1, R"(<controller config="c"/>)");
    for (int box = 0; box < 5; ++box) {
      text += body(fmt::format("seen{}_{}", i, box), x + 0.45, y + 0.05 * (box - 2), 0.04,
                   tag_and_leds(6));
    }
  }
  std::mt19937_64 random(1);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int i = 0; i < 180; ++i) {  // between the rows
    const double x = draw(-5, 5), y = 1.25 * std::floor(draw(-4, 4)) + draw(-0.1, 0.1);
    text += body(fmt::format("near{}", i), x, y, 0.04, tag_and_leds(i < 80 ? 1 : 0));
  }
  for (int i = 0; i < far_tags; ++i) {
    const double distance = draw(20, 60), angle = draw(-std::numbers::pi, std::numbers::pi);
    text += body(fmt::format("far{}", i), distance * std::cos(angle), distance * std::sin(angle),
                 0.04, tag_and_leds(0));
  }
  return text;
}

scene::Scene read(int far_tags) {
  const std::string text =
      R"(<argos><framework><experiment ticks_per_second="5"/></framework><controllers>)"
      R"(<external_controller id="c"><actuators/><sensors><cameras implementation="default">)"
      R"(<camera id="c" anchor="b" position="0.06,0,0.03" orientation="-90,90,0" )"
      R"(range="0.05:0.6" focal_length="884,884" principal_point="320,180" )"
      R"(resolution="640,360"><led_detector medium="leds"/><tag_detector medium="tags"/></camera>)"
      R"(</cameras></sensors><params/></external_controller></controllers><arena size="9,9,9">)" +
      arena(far_tags) +
      R"(</arena><physics_engines><dynamics3d id="d"/></physics_engines>)"
      R"(<media><led id="leds"/><tag id="tags"/></media></argos>)";
  scene::ReadResult result = scene::read_text(text, "bench");
  for (const scene::Problem& problem : result.problems) {
    fmt::print(stderr, "{}\n", scene::to_string(problem));
  }
  return std::move(result.scene);
}

/// Processor time of this thread [µs]; independent of other programs.
double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_nsec) / 1e3;
}

double median(std::vector<double>& values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void count_rays(const world::Layout& shown, devices::Tick tick, devices::Kind& cameras) {
  devices::Tick counted{shown,        tick.state, tick.observations, tick.commands,
                        tick.physics, tick.rays,  tick.index};
  cameras.sense(counted);
  const double tags = static_cast<double>(tick.observations.tags.size());
  const double leds = static_cast<double>(tick.observations.leds.size());
  fmt::print("  a camera sees {:.2f} tags and {:.2f} LEDs; ", tags / 64, leds / 64);
  double tag_rays = 0;
  for (const world::Ray& ray : tick.state.rays) tag_rays += ray.kind == world::Ray::Kind::camera;
  fmt::print("rays for tags per visible tag {:.2f}\n", tag_rays / tags);
  tick.state.rays.clear();
}

double measure(int far_tags) {
  const scene::Scene scene = read(far_tags);
  const std::vector<scene::Entity> entities = simulation::place_entities(scene, 1);
  const world::Layout layout = simulation::make_layout(scene, entities, 0.01);
  physics::World physics(scene.physics, 0.01);
  physics::Rays rays(scene.physics);
  for (const scene::Entity& entity : entities) {
    physics.add(entity);
    rays.add(entity);
  }
  world::State state;
  physics.read(state);
  for (const auto& led : layout.leds) state.led_colors.push_back(led.color);
  for (const auto& tag : layout.tags) state.tag_payloads.push_back(tag.payload);
  world::Observations observations;
  world::Commands commands;
  media::DevicesIndex index(layout);
  const std::unique_ptr<devices::Kind> cameras = devices::make_cameras();
  devices::Tick tick{layout, state, observations, commands, physics, rays, index};
  std::vector<double> updates, kept, builds, looks;
  for (int i = 0; i < 300; ++i) {
    // In every second tick all bodies move a little, so that the index is rebuilt.
    if (i % 2 == 0) {
      for (auto& link : state.links) link.pose.position.y() += i % 4 ? 1e-9 : -1e-9;
    }
    const double start = now();
    rays.update(state);
    const double updated = now();
    index.build(state);
    const double built = now();
    cameras->sense(tick);
    const double end = now();
    if (i < 4) continue;
    updates.push_back(updated - start);
    (i % 2 ? kept : builds).push_back(built - updated);
    looks.push_back(end - built);
  }
  const double look = median(looks);
  fmt::print("{} tags, {} LEDs, {} of the tags far away\n", layout.tags.size(), layout.leds.size(),
             far_tags);
  fmt::print("  64 cameras take {:.0f} µs per tick, {:.2f} µs per camera\n", look, look / 64);
  fmt::print("  in addition: index {:.0f} µs when all moved, {:.0f} µs when nothing moved; ",
             median(builds), median(kept));
  fmt::print("boxes of the rays {:.0f} µs (median over both)\n", median(updates));
  world::Layout shown = layout;
  for (auto& camera : shown.cameras) camera.tags->shows_rays = true;
  count_rays(shown, tick, *cameras);
  return look;
}

}  // namespace

int main() {
  const double near = measure(0), all = measure(5000);
  fmt::print("with the far tags the cameras take {:.2f} times as long\n", all / near);
}
