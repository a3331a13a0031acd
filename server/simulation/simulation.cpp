#include "simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "devices/devices.h"
#include "media/devices_index.h"
#include "physics/ray.h"
#include "physics/world.h"
#include "simulation/layout.h"
#include "simulation/place.h"

namespace ziggurat::simulation {
namespace {

/// Physical time that a substep covers [s].
double substep_length(const scene::Scene& scene, const Options& options) {
  const double tick = 1.0 / scene.experiment.ticks_per_second;
  const double iterations = scene.physics.iterations;
  const bool slow = options.clock.value_or(scene.physics.clock) == scene::Clock::beta50;
  return slow ? tick / (iterations * iterations) : tick / iterations;
}

}  // namespace

struct Simulation::Parts {
  Parts(const scene::Scene& scene, const Options& options, world::Layout& layout);

  devices::Tick tick() { return {layout, state, observations, commands, physics, rays, *index}; }
  void look_around();  // rays and index take the poses of the state

  unsigned ticks_per_second;
  unsigned substeps;
  double substep;  // [s]
  physics::World physics;
  physics::Rays rays;
  const world::Layout& layout;
  world::State state;
  world::Observations observations;
  world::Commands commands;
  std::optional<media::DevicesIndex> index;
  std::optional<devices::Devices> devices;
};

Simulation::Parts::Parts(const scene::Scene& scene, const Options& options, world::Layout& made)
    : ticks_per_second(scene.experiment.ticks_per_second),
      substeps(scene.physics.iterations),
      substep(substep_length(scene, options)),
      physics(scene.physics, substep),
      rays(scene.physics),
      layout(made) {
  const std::vector<scene::Entity> entities = place(scene, options.seed);
  made = make_layout(scene, entities);
  for (const scene::Entity& entity : entities) {
    physics.add(entity);
    rays.add(entity);
  }
  index.emplace(layout);
  devices.emplace(devices::Setting{scene, entities, layout, options.seed, 1.0 / ticks_per_second},
                  physics);
  physics.read(state);
  look_around();
  devices::Tick first = tick();
  devices->start(first);
}

void Simulation::Parts::look_around() {
  if (devices->casts_rays()) rays.update(state);
  if (devices->needs_index()) index->build(state);
}

Simulation::Simulation(const scene::Scene& scene, const Options& options)
    : layout_(std::make_unique<world::Layout>()),
      parts_(std::make_unique<Parts>(scene, options, *layout_)) {}
Simulation::~Simulation() = default;

void Simulation::reset(const scene::Scene& scene, const Options& options) {
  parts_ = std::make_unique<Parts>(scene, options, *layout_);
}

void Simulation::move(std::size_t entity, const math::Pose& pose) {
  parts_->physics.move(entity, pose);
  parts_->physics.read(parts_->state);
  parts_->look_around();
}

const world::Layout& Simulation::layout() const { return *layout_; }
const world::State& Simulation::state() const { return parts_->state; }
const world::Observations& Simulation::observations() const { return parts_->observations; }
world::Commands& Simulation::commands() { return parts_->commands; }

void Simulation::step() {
  Parts& p = *parts_;
  devices::Tick tick = p.tick();
  p.state.rays.clear();
  p.state.frusta.clear();
  p.devices->apply(tick);
  for (unsigned i = 0; i < p.substeps; ++i) p.physics.step();
  p.state.tick += 1;
  p.state.time_ns =
      std::llround(static_cast<long double>(p.state.tick) * 1e9L / p.ticks_per_second);
  p.physics.read(p.state);
  p.look_around();
  p.observations.tick = p.state.tick;
  p.observations.time_ns = p.state.time_ns;
  p.devices->sense(tick);
}

std::uint64_t Simulation::hash() const { return world::hash(parts_->state, parts_->observations); }
std::vector<std::string> Simulation::notices() const {
  const physics::World::Stiffness bond = parts_->physics.stiffest_bond();
  if (bond.product < bond.safe) return {};
  return {fmt::format(
      "two bodies like '{}' bonded by their magnets swing too fast for substeps of {:.3g} s "
      "(substep times rate is {:.2f}; up to {} is safe, from 2 on they tremble); write more "
      "iterations, or max_substep=\"{:.2g}\" on <dynamics3d>",
      parts_->layout.entities[bond.entity].id, bond.substep, bond.product, bond.safe,
      0.9 * bond.substep * bond.safe / bond.product)};
}

double Simulation::tick_length() const { return 1.0 / parts_->ticks_per_second; }
double Simulation::physical_length() const { return parts_->substep * parts_->substeps; }

}  // namespace ziggurat::simulation
