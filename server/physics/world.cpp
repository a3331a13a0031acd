// SPDX-License-Identifier: MIT
#include "physics/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/archive.h"
#include "physics/bodies/convert.h"
#include "physics/core.h"
#include "physics/forces.h"
#include "physics/magnets.h"
#include "physics/plugins.h"

namespace ziggurat::physics {

namespace {

/// X_WL.
math::Pose link_pose(const Body& body, const LinkBody& link) {
  math::Pose pose = from_bullet(body.transform(link));
  // Hulls only: a product with 1 would change the signs of zeros, and with them the hash.
  if (link.center.orientation.w() != 1) {
    pose.orientation = pose.orientation * link.center.orientation.conjugate();
  }
  pose.position -= pose.orientation * link.center.position;
  return pose;
}

}  // namespace

struct World::Parts {
  Parts(const scene::Physics& physics, double substep)
      : settings(physics),
        splits(physics.max_substep && substep > *physics.max_substep
                   ? static_cast<int>(std::ceil(substep / *physics.max_substep))
                   : 1),
        length(substep / splits),
        core(physics),
        plugins(physics, core) {
    auto pushed = std::make_unique<ExternalForces>();
    pushes = pushed.get();
    plugins.add(std::move(pushed));
  }

  scene::Physics settings;
  int splits;               // internal substeps per substep
  double length;            // of an internal substep [s]
  std::size_t stepped = 0;  // so many bodies have been through a step; the rest is as placed
  std::size_t link_count = 0, magnet_count = 0;
  std::vector<std::vector<Twist>> motions{1};  // memory of read(), of each thread
  std::uint64_t sleep_changes = 0;    // when all was read, see dynamics::System::sleep_changes()
  std::vector<LinkContact> contacts;  // the same of list_contacts()

  std::vector<Body> bodies;
  NewtonCore core;
  Plugins plugins;
  ExternalForces* pushes = nullptr;  // one of the plug-ins

  void read(const Body& body, world::State& state, std::vector<Twist>& motions_of_parts) const;
};

World::World(const scene::Physics& physics, double substep)
    : parts_(std::make_unique<Parts>(physics, substep)) {}
World::~World() = default;

void World::add(const scene::Entity& entity) {
  Parts& p = *parts_;
  if (p.bodies.size() == p.bodies.capacity()) p.bodies.reserve(2 * p.bodies.size() + 1);
  p.bodies.push_back(p.core.add(entity, p.bodies.size()));
  Body& body = p.bodies.back();
  body.first_link = p.link_count;
  body.first_magnet = p.magnet_count;
  p.link_count += body.links.size();
  p.magnet_count += body.magnets.size();
  try {
    p.plugins.add(body);
  } catch (...) {
    take_back();
    throw;
  }
}

void World::take_back() {
  Parts& p = *parts_;
  Body& body = p.bodies.back();
  p.plugins.remove(body);
  p.core.take_back(body);
  p.link_count = body.first_link;
  p.magnet_count = body.first_magnet;
  p.bodies.pop_back();
}

void World::remove(std::size_t entity) {
  Parts& p = *parts_;
  Body& body = p.bodies[entity];
  p.plugins.remove(body);
  p.core.remove(body);
  // Without links: nothing acts on it, nothing is read of it.
  const Body gone = std::exchange(body, Body{});
  body.entity = entity;
  body.first_link = gone.first_link;
  body.first_magnet = gone.first_magnet;
}

std::optional<std::size_t> World::overlapped_by(const scene::Entity& entity, const math::Pose& pose,
                                                std::optional<std::size_t> except) const {
  return parts_->core.overlapped_by(placed_colliders(entity, pose), except.value_or(no_entity));
}

JointIndex World::joint(std::size_t entity, std::size_t joint) const {
  return parts_->core.joint(entity, joint);
}

void World::add_motor(JointIndex joint, scene::JointMode mode, double max_impulse) {
  parts_->core.add_motor(joint, mode, max_impulse);
}

void World::set_target(JointIndex joint, double target) { parts_->core.set_target(joint, target); }
double World::position(JointIndex joint) const { return parts_->core.position(joint); }
double World::velocity(JointIndex joint) const { return parts_->core.velocity(joint); }

void World::set_velocity(std::size_t entity, double velocity, double angular_velocity) {
  GroundMotion& ground = parts_->bodies[entity].ground.value();
  ground.velocity = velocity;
  ground.angular_velocity = angular_velocity;
}

void World::set_turret(std::size_t entity, std::optional<double> speed) {
  Turret& turret = parts_->bodies[entity].turret.value();
  turret.follows = !speed;
  turret.speed = speed.value_or(0);
}

double World::turret(std::size_t entity) const {
  return parts_->bodies[entity].turret.value().angle;
}

void World::grip(std::size_t entity, const Gripper& gripper) {
  parts_->core.grip(parts_->bodies, entity, gripper);
}

void World::release(std::size_t entity) { parts_->core.release(entity); }

bool World::holds(std::size_t entity) const {
  const Grip* const grip = parts_->core.grip_of(entity);
  return grip && !grip->is_torn;
}

FlightTarget& World::flight_target(std::size_t entity) {
  return parts_->bodies[entity].flight.value().target;
}

void World::set_currents(std::span<const double> currents) {
  for (Body& body : parts_->bodies) {
    for (std::size_t i = 0; i < body.magnets.size(); ++i) {
      body.magnets[i].current = currents[body.first_magnet + i];
    }
  }
}

void set_pushes(World& world, std::span<const world::Push> pushes) {
  const std::vector<Body>& bodies = world.parts_->bodies;
  std::vector<ExternalForces::Force> list;
  for (const world::Push& push : pushes) {
    const auto behind = std::ranges::upper_bound(bodies, push.link, {}, &Body::first_link);
    const std::size_t entity = static_cast<std::size_t>(behind - bodies.begin()) - 1;
    list.push_back({entity, push.link - bodies[entity].first_link, push.force, push.torque});
  }
  world.parts_->pushes->set(std::move(list));
}

void set_joint(World& world, std::size_t entity, JointIndex joint, double position,
               double velocity) {
  World::Parts& p = *world.parts_;
  set_joint(p.core, joint, position, velocity);
  p.plugins.move(p.bodies[entity]);
  p.stepped = std::max(p.stepped, entity + 1);  // its links are no longer where they were placed
}

void World::watch_contacts(std::size_t entity, std::size_t link) {
  Body& body = parts_->bodies[entity];
  body.links[link].touch.emplace();
  parts_->plugins.watch(body);
}

LinkTouch World::take_touch(std::size_t entity, std::size_t link) {
  Body& body = parts_->bodies[entity];
  if (body.links.empty()) return {};
  return std::exchange(body.links[link].touch.value(), LinkTouch{});
}

void World::list_contacts(std::vector<world::Contact>& to) const {
  Parts& p = *parts_;
  p.core.contacts(p.contacts);
  const auto link_of = [&](const ContactSide& side) {
    return p.bodies[side.entity].first_link + side.link;
  };
  to.clear();
  for (const LinkContact& contact : p.contacts) {
    world::Contact& entry = to.emplace_back();
    entry.link = link_of(contact.a);
    if (contact.b.entity != ContactSide::floor) entry.other = link_of(contact.b);
    entry.point = contact.point;
    entry.normal = contact.normal;
    entry.force = contact.impulse / p.length;
  }
}

void World::move(std::size_t entity, const math::Pose& pose) {
  Body& body = parts_->bodies[entity];
  const math::Pose from_placed = pose * math::inverse(body.placed);
  body.placed = pose;
  for (LinkBody& link : body.links) {
    link.placed = from_placed * link.placed;
    link.turn = math::Quaternion::Identity();
  }
  parts_->core.move(body);
  parts_->plugins.move(body);
}

void World::step(timing::Stopwatch* watch) {
  Parts& p = *parts_;
  p.stepped = p.bodies.size();
  for (int split = 0; split < p.splits; ++split) {
    p.plugins.before_substep(p.bodies, p.length, watch);
    p.core.substep(p.bodies, p.length, p.splits, p.plugins.stiff(), watch);
    p.core.end_grips(p.bodies);
    enter(watch, timing::Phase::sensing);
    p.plugins.after_substep(p.bodies, p.length, p.core);
  }
}

void World::set_threads(unsigned threads) {
  parts_->core.set_threads(threads);
  parts_->motions.resize(std::max(1U, threads));
}

dynamics::Team* World::team() const { return parts_->core.team(); }

void World::read(world::State& state) const {
  parts_->sleep_changes = 0;
  read_moved(state);
}

void World::read_moved(world::State& state) const {
  constexpr std::size_t block = 16;  // bodies that a thread takes at once
  Parts& p = *parts_;
  const std::uint64_t changes = p.core.sleep_changes();
  const bool skips_sleepers = std::exchange(p.sleep_changes, changes) == changes;
  state.origins.resize(p.bodies.size());
  state.links.resize(p.link_count);
  dynamics::share_in_blocks(team(), p.bodies.size(), block, [&](std::size_t i, unsigned member) {
    const Body& body = p.bodies[i];
    if (body.links.empty()) return;  // removed
    if (skips_sleepers && !body.turns_asleep() && body.sleeps()) return;
    p.read(body, state, p.motions[member]);
  });
}

void World::read(std::size_t entity, world::State& state) const {
  Parts& p = *parts_;
  state.origins.resize(p.bodies.size());
  state.links.resize(p.link_count);
  p.read(p.bodies[entity], state, p.motions.front());
}

void World::Parts::read(const Body& body, world::State& state,
                        std::vector<Twist>& motions_of_parts) const {
  const bool was_stepped = body.entity < stepped;
  body.motions(motions_of_parts);
  for (std::size_t i = 0; i < body.links.size(); ++i) {
    const LinkBody& link = body.links[i];
    world::LinkState& out = state.links[body.first_link + i];
    out.pose = link.placed;
    if (was_stepped && link.moves) out.pose = link_pose(body, link);
    const Twist motion = body.motion(link, motions_of_parts);
    out.angular_velocity = from_bullet(motion.angular_velocity);
    const math::Vector3 arm = out.pose.orientation * -link.center.position;
    out.velocity = from_bullet(motion.velocity) + out.angular_velocity.cross(arm);
  }
  const math::Pose& reference = state.links[body.first_link + body.reference_link].pose;
  state.origins[body.entity] = was_stepped ? reference * body.origin_from_reference : body.placed;
}

void archive_fields(math::Archive& archive, World& world) {
  World::Parts& p = *world.parts_;
  archive("bodies", p.bodies);
  archive("stepped", p.stepped);
  archive.require(p.stepped <= p.bodies.size(), "is more than there are bodies");
  archive("core", p.core);
  p.plugins.archive(archive, p.bodies);
}

Convergence World::convergence() const { return parts_->core.convergence(); }

World::Stiffness World::stiffest_bond() const {
  const Parts& p = *parts_;
  if (!p.settings.magnetism) return {.substep = p.length};
  const StiffestBond stiffest = physics::stiffest_bond(p.bodies, *p.settings.magnetism);
  return {.entity = stiffest.entity,
          .product = stiffest.rate * p.length,
          .substep = p.length,
          .safe = stiffest.safe};
}

double World::energy() const {
  double total = 0;
  const double gravity = parts_->settings.gravity.value_or(0);
  std::vector<Twist> motions;
  for (const Body& body : parts_->bodies) {
    if (body.links.empty()) continue;
    body.motions(motions);
    for (std::size_t i = 0; i < body.parts.size(); ++i) {
      const Part& part = body.parts[i];
      if (!part.moves) continue;
      const btTransform pose = body.transform(i);
      const btVector3 w = pose.getBasis().transpose() * motions[i].angular_velocity;
      total += part.mass * (motions[i].velocity.length2() / 2 + gravity * pose.getOrigin().z());
      total += (to_bullet(part.inertia) * w).dot(w) / 2;
    }
  }
  return total;
}

}  // namespace ziggurat::physics
