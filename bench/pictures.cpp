// Time of a picture: a hundred boxes with a tag and an LED each, on a floor, with shadows. Measures the
// processor time of all threads, which other programs affect little.

#include <fmt/format.h>

#include <ctime>
#include <string>

#include "render/renderer.h"

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

void measure(const World& world, unsigned width, unsigned height, unsigned oversampling) {
  render::Renderer renderer(world.scene, world.entities, world.layout);
  render::View view =
      render::symmetric_view(render::look_at({0, 0, 0.3}, {1.5, 0, 0}), 0.9, width, height);
  view.oversampling = oversampling;
  render::Picture picture;
  const double begin = processor_ms();
  renderer.draw(world.state, view, picture);
  const double first = processor_ms() - begin;
  constexpr int pictures = 30;
  for (int i = 0; i < pictures; ++i) renderer.draw(world.state, view, picture);
  const double each = (processor_ms() - begin - first) / pictures;
  fmt::print("{} x {}, oversampling {}: first picture {:.0f} ms, each further one {:.1f} ms\n", width, height,
             oversampling, first, each);
}

}  // namespace

int main() {
  const World world;
  for (const unsigned oversampling : {1u, 2u}) {
    measure(world, 320, 240, oversampling);
    measure(world, 640, 480, oversampling);
    measure(world, 1280, 720, oversampling);
  }
}
