// SPDX-License-Identifier: MIT
#include "simulation/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "simulation/layout.h"
#include "simulation/parts.h"
#include "simulation/placement.h"

namespace ziggurat::simulation {
namespace {

/// Physical time that a substep covers [s].
double substep_length(const scene::Scene& scene) {
  const double tick = 1.0 / scene.experiment.ticks_per_second;
  const double iterations = scene.physics.iterations;
  const bool slow = scene.physics.clock == scene::Clock::beta50;
  return slow ? tick / (iterations * iterations) : tick / iterations;
}

/// 0 for finite numbers, otherwise NaN; so that one comparison does for many numbers.
double excess(const math::Pose& pose) {
  return 0.0 * (pose.position.sum() + pose.orientation.coeffs().sum());
}

double excess(const world::LinkState& link) {
  return excess(link.pose) + 0.0 * (link.velocity.sum() + link.angular_velocity.sum());
}

/// The world before an entity is added to it; puts it back unless told to keep the new one. Putting
/// back moves and shrinks only, so that it can't fail.
class Growing {
 public:
  explicit Growing(Parts& parts)
      : parts_(parts),
        layout_(parts.layout),
        state_(parts.state),
        observations_(parts.observations),
        commands_(parts.commands),
        devices_(parts.devices),
        index_(std::move(parts.index)) {}
  Growing(const Growing&) = delete;
  Growing& operator=(const Growing&) = delete;
  ~Growing() {
    if (kept_) return;
    const std::size_t count = layout_.entities.size();
    parts_.layout = std::move(layout_);
    parts_.state = std::move(state_);
    parts_.observations = std::move(observations_);
    parts_.commands = std::move(commands_);
    parts_.devices = std::move(devices_);
    parts_.index = std::move(index_);
    if (parts_.entities.size() > count) parts_.entities.pop_back();
    if (parts_.in_physics > count) parts_.physics.take_back();
    if (parts_.in_rays > count) parts_.rays.take_back();
    parts_.in_physics = parts_.in_rays = count;
    parts_.looks_are_old = true;
  }

  void keep() { kept_ = true; }

 private:
  Parts& parts_;
  world::Layout layout_;
  world::State state_;
  world::Observations observations_;
  world::Commands commands_;
  devices::Devices devices_;
  std::optional<media::DevicesIndex> index_;
  bool kept_ = false;
};

}  // namespace

Parts::Parts(const scene::Scene& scene, const Options& options, world::Layout& into)
    : seed(options.seed),
      ticks_per_second(scene.experiment.ticks_per_second),
      substeps(scene.physics.iterations),
      substep(substep_length(scene)),
      physics(scene.physics, substep),
      rays(scene.physics),
      layout(into) {
  entities = place_entities(scene, options.seed, options.tell);
  layout = make_layout(scene, entities, substep);
  constexpr std::size_t between_messages = 100;
  for (std::size_t i = 0; i < entities.size(); ++i) {
    physics.add(entities[i]);
    rays.add(entities[i]);
    if (options.tell && i % between_messages == 0) options.tell(Step::building, i, entities.size());
  }
  in_physics = in_rays = entities.size();
  index.emplace(layout);
  devices.add({scene, entities, layout, seed, 1.0 / ticks_per_second, substep, physics, 0, 0,
               [&] { return entities; }});
  physics.read(state);
  look_around();
  devices::Tick first = tick();
  devices.start(first);
}

void Parts::look_around() {
  if (devices.casts_rays()) rays.update(state, physics.team());
  if (devices.needs_index()) index->build(state);
  looks_are_old = false;
}

void Parts::spawn(const scene::Scene& scene, const scene::Entity& entity) {
  Growing before(*this);
  grow(scene, entity);
  before.keep();
}

void Parts::grow(const scene::Scene& scene, const scene::Entity& entity) {
  const std::size_t first_entity = layout.entities.size(), first_robot = layout.robots.size();
  append(scene, entity, devices, substep, layout);
  entities.push_back(entity);
  physics.add(entity);
  ++in_physics;
  rays.add(entity);
  ++in_rays;
  index.emplace(layout);
  devices.add({scene, std::span(&entity, 1), layout, seed, 1.0 / ticks_per_second, substep, physics,
               first_entity, first_robot, [&] { return entities; }});
  physics.read(first_entity, state);
  looks_are_old = true;
  devices::Tick first = tick();
  devices.start(first);
}

void Parts::remove(std::size_t entity) {
  physics.remove(entity);
  rays.remove(entity);
  state.absent.resize(layout.entities.size());
  state.absent[entity] = true;
  std::erase_if(commands.radio_messages.entries, [&](const auto& message) {
    return layout.radios[message.radio].mount.entity == entity;
  });
  std::erase_if(commands.pushes,
                [&](const auto& push) { return layout.links[push.link].entity == entity; });
  const auto is_of_entity = [&](const world::Marker& marker) {
    return layout.robots[marker.robot].entity == entity;
  };
  std::erase_if(commands.markers, is_of_entity);
  std::erase_if(state.markers, is_of_entity);
  looks_are_old = true;
}

Simulation::Simulation(const scene::Scene& scene, const Options& options)
    : layout_(std::make_unique<world::Layout>()),
      parts_(std::make_unique<Parts>(scene, options, *layout_)) {}
Simulation::~Simulation() = default;

void Simulation::set_threads(unsigned threads) {
  parts_->physics.set_threads(threads);
  threads_ = threads;
}

void Simulation::reset(const scene::Scene& scene, const Options& options) {
  world::Layout before = *layout_;
  try {
    auto made = std::make_unique<Parts>(scene, options, *layout_);
    made->physics.set_threads(threads_);
    parts_ = std::move(made);
  } catch (...) {
    *layout_ = std::move(before);
    throw;
  }
}

void Parts::list_contacts(bool wanted) {
  lists_contacts = wanted;
  contacts.clear();
  if (wanted) physics.list_contacts(contacts);
}

void Parts::move(std::size_t entity, const math::Pose& pose) {
  physics.move(entity, pose);
  physics.read(entity, state);
  looks_are_old = true;
}

void Simulation::move(std::size_t entity, const math::Pose& pose) { parts_->move(entity, pose); }

std::optional<std::size_t> overlapped_by(const Simulation& in, const scene::Entity& entity,
                                         const math::Pose& pose,
                                         std::optional<std::size_t> except) {
  return in.parts().physics.overlapped_by(entity, pose, except);
}

void Simulation::spawn(const scene::Scene& scene, const scene::Entity& entity, std::string xml) {
  if (const auto other = overlapped_by(*this, entity, entity.pose)) {
    scene::Problem problem;
    problem.file = scene::file_of(scene, entity.where);
    problem.where = entity.where;
    problem.text = fmt::format("'{}' overlaps '{}' where it is placed; choose a place that is free",
                               entity.id, layout_->entities[*other].id);
    throw scene::SceneError({problem});
  }
  WorldEdit edit{WorldEdit::Kind::spawn, parts_->state.tick, layout_->entities.size(),
                 std::make_shared<const scene::Entity>(entity), std::move(xml)};
  auto& edits = parts_->history.edits;
  if (edits.size() == edits.capacity())
    edits.reserve(2 * edits.size() + 1);  // what is done can be written down
  parts_->spawn(scene, entity);
  edits.push_back(std::move(edit));
}

void Simulation::remove(std::size_t entity) {
  parts_->remove(entity);
  parts_->history.edits.push_back({WorldEdit::Kind::remove, parts_->state.tick, entity, {}, {}});
}

const world::Layout& Simulation::layout() const { return *layout_; }
const std::vector<scene::Entity>& Simulation::entities() const { return parts_->entities; }
const world::State& Simulation::state() const { return parts_->state; }
const world::Observations& Simulation::observations() const { return parts_->observations; }
world::Commands& Simulation::commands() { return parts_->commands; }

void Simulation::step(timing::Stopwatch* watch) { parts_->step(watch); }

std::optional<std::size_t> first_not_finite(const world::Layout& layout,
                                            const world::State& state) {
  double sum = 0;
  for (const math::Pose& origin : state.origins) sum += excess(origin);
  for (const world::LinkState& link : state.links) sum += excess(link);
  if (sum == 0) return std::nullopt;
  for (std::size_t i = 0; i < layout.entities.size(); ++i) {
    double of_entity = excess(state.origins[i]);
    const world::Range links = layout.entities[i].links;
    for (std::size_t l = links.begin; l < links.end(); ++l) of_entity += excess(state.links[l]);
    if (of_entity != 0) return i;
  }
  return std::nullopt;
}

void Parts::step(timing::Stopwatch* watch) {
  enter(watch, timing::Phase::forces);
  devices::Tick now = tick();
  for (const world::FloorPaint& region : commands.floor_paints) world::paint(state.floor, region);
  commands.floor_paints.clear();
  state.markers.swap(commands.markers);
  commands.markers.clear();
  state.rays.clear();
  all_rays.clear();
  state.frusta.clear();
  devices.apply(now);
  set_pushes(physics, commands.pushes);
  for (unsigned i = 0; i < substeps; ++i) {
    physics.step(watch);
    devices.after_substep(now);
  }
  if (lists_contacts) physics.list_contacts(contacts);
  commands.pushes.clear();
  state.tick += 1;
  state.time_ns = std::llround(static_cast<long double>(state.tick) * 1e9L / ticks_per_second);
  physics.read_moved(state);
  if (const auto entity = first_not_finite(layout, state)) {
    throw std::runtime_error(fmt::format(
        "tick {}: the pose or velocity of '{}' is not finite any more; look for forces, speeds or "
        "stiff motors that are too large for the substep, or write more iterations on <dynamics3d>",
        state.tick, layout.entities[*entity].id));
  }
  look_around();
  observations.tick = state.tick;
  observations.time_ns = state.time_ns;
  devices.sense(now);
}

void Simulation::list_contacts(bool wanted) {
  if (wanted != parts_->lists_contacts) parts_->list_contacts(wanted);
}
void Simulation::list_rays(bool wanted) {
  parts_->lists_rays = wanted;
  if (!wanted) parts_->all_rays.clear();
}
const std::vector<world::Ray>& Simulation::rays() const { return parts_->all_rays; }
const std::vector<world::Contact>& Simulation::contacts() const { return parts_->contacts; }

std::uint64_t Simulation::hash() const { return world::hash(parts_->state, parts_->observations); }
std::vector<std::string> Simulation::notices() const {
  const physics::World::Stiffness bond = parts_->physics.stiffest_bond();
  if (bond.product < bond.safe) return {};
  return {fmt::format(
      "two bodies like '{}' bonded by their magnets swing too fast for substeps of {:.3g} s, and "
      "may "
      "gain energy (substep times rate is {:.2f}; it is safe below {}); write more iterations, or "
      "max_substep=\"{:.2g}\" on <dynamics3d>",
      parts_->layout.entities[bond.entity].id, bond.substep, bond.product, bond.safe,
      0.9 * bond.substep * bond.safe / bond.product)};
}

std::optional<std::string> slow_notice(const Simulation& simulation) {
  constexpr std::size_t often = 100;  // substeps
  const Parts& parts = simulation.parts();
  const physics::Convergence convergence = parts.physics.convergence();
  if (convergence.divided < often) return std::nullopt;
  return fmt::format(
      "'{}' makes the run slow: its substeps of {:.3g} s are divided into {} parts and more, "
      "because it is pulled harder, "
      "or turns faster, than they can follow; make the masses that hang on its joints lighter, or "
      "its links heavier",
      parts.layout.entities[convergence.divided_entity].id, parts.substep, physics::many_parts);
}

physics::Convergence Simulation::convergence() const { return parts_->physics.convergence(); }

double Simulation::tick_length() const { return 1.0 / parts_->ticks_per_second; }
double Simulation::physical_length() const { return parts_->substep * parts_->substeps; }

}  // namespace ziggurat::simulation
