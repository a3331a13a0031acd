#include "physics/world.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "magnetism/stiffness.h"
#include "physics/convert.h"
#include "physics/dynamics.h"
#include "physics/floor.h"
#include "physics/forces.h"
#include "physics/joints.h"
#include "physics/magnets.h"
#include "physics/move.h"
#include "physics/overlap.h"
#include "physics/solver.h"

namespace ziggurat::physics {
namespace {

// By measurement: the four-wheeled vehicle's encoders stay within 1 % at 50 sweeps and not at
// 20; a loose body comes to rest as well with 10 as with 50.
constexpr unsigned default_solver_iterations = 50;
constexpr int default_sweeps_per_body = 10;

void configure(btContactSolverInfo& info, const scene::Physics& physics) {
  info.m_numIterations =
      static_cast<int>(physics.solver_iterations.value_or(default_solver_iterations));
  info.m_solverMode = SOLVER_SIMD | SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS;
  info.m_warmstartingFactor = 0.5;  // at Bullet's 0.85 stacks tremble
  info.m_splitImpulse = false;      // its threshold is in raw metres, and multi-bodies ignore it
  info.m_erp = info.m_erp2 = 0.2;
  info.m_frictionERP = 0.2;
  // Sweeps end early once no row changes a velocity by more than this [m/s or rad/s], squared.
  info.m_leastSquaresResidualThreshold = 1e-8;
  info.m_minimumSolverBatchSize = 1;  // each island ends its sweeps when it is done
}

}  // namespace

struct World::Parts {
  Parts(const scene::Physics& physics, double substep)
      : settings(physics),
        gravity(physics.gravity.value_or(0)),
        splits(physics.max_substep && substep > *physics.max_substep
                   ? static_cast<int>(std::ceil(substep / *physics.max_substep))
                   : 1),
        length(substep / splits),
        configuration(contact::construction_info()),
        dispatcher(&configuration),
        algorithms(contact::register_algorithms(dispatcher)),
        solver(physics.solver_iterations ? static_cast<int>(*physics.solver_iterations)
                                         : default_sweeps_per_body),
        dynamics(dispatcher, broadphase, solver, configuration) {
    configure(dynamics.getSolverInfo(), physics);
    gDeactivationTime = 0.5;  // the one global of Bullet that we set; the same for every world [s]
    dynamics.setGravity(btVector3(0, 0, 0));
    if (physics.floor) plugins.push_back(std::make_unique<Floor>(*physics.floor, dynamics));
    if (physics.gravity) plugins.push_back(std::make_unique<Gravity>(*physics.gravity));
    plugins.push_back(std::make_unique<ViscousDamping>());
    if (physics.magnetism) {
      auto plugin = std::make_unique<Magnets>(*physics.magnetism);
      magnets = plugin.get();
      plugins.push_back(std::move(plugin));
    }
  }
  ~Parts();

  void add_joints(const scene::Entity& entity, Body& body);
  void detach(MovingJoint& joint);
  void detach(Body& body);

  scene::Physics settings;
  double gravity;           // [m/s^2]
  int splits;               // internal substeps per substep
  double length;            // of an internal substep [s]
  std::size_t stepped = 0;  // so many bodies have been through a step; the rest is as placed

  /// Room that read() works in, kept so that a tick does not allocate it.
  struct Reading {
    std::vector<Motion> motions;
    btAlignedObjectArray<btQuaternion> rotations;
    btAlignedObjectArray<btVector3> positions;
  } reading;

  // Destroyed from the end: the world before what it points to.
  std::vector<Body> bodies;
  std::vector<MovingJoint> joints;
  std::vector<std::size_t> motors;  // into joints
  std::vector<std::size_t> driven;  // into bodies
  std::size_t link_count = 0;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  std::unique_ptr<btCollisionAlgorithmCreateFunc> algorithms;
  btDbvtBroadphase broadphase;
  Solver solver;
  Dynamics dynamics;
  std::vector<std::unique_ptr<Plugin>> plugins;
  Magnets* magnets = nullptr;  // one of them, if the scene has magnetism
};

World::Parts::~Parts() {
  for (MovingJoint& joint : joints) detach(joint);
  for (Body& body : bodies) detach(body);
}

/// Takes it out of Bullet's world.
void World::Parts::detach(MovingJoint& joint) {
  if (joint.limit) dynamics.removeMultiBodyConstraint(joint.limit.get());
  if (joint.motor.constraint) dynamics.removeMultiBodyConstraint(joint.motor.constraint.get());
}

void World::Parts::detach(Body& body) {
  if (body.drive) dynamics.removeConstraint(body.drive.get());
  for (auto& collider : body.link_colliders) dynamics.removeCollisionObject(collider.get());
  if (body.multi) dynamics.removeMultiBody(body.multi.get());
  if (body.rigid) dynamics.removeRigidBody(body.rigid.get());
}

/// Puts the turret where the drive has it.
void pose_turret(Body& body) {
  if (!body.turret) return;
  const Drive& drive = *body.drive;
  LinkBody& turret = body.links[*body.turret];
  turret.turn = Eigen::AngleAxisd(drive.turret_angle, math::Vector3::UnitZ());
  turret.spin = drive.turret_follows ? 0
                                     : drive.angular_velocity + drive.turret_speed -
                                           body.rigid->getAngularVelocity().z();
}

void World::Parts::add_joints(const scene::Entity& entity, Body& body) {
  for (std::size_t i = 0; i < entity.joints.size(); ++i) {
    const scene::Joint& joint = entity.joints[i];
    if (joint.type != scene::JointType::revolute && joint.type != scene::JointType::prismatic)
      continue;
    MovingJoint moving;
    moving.entity = body.entity;
    moving.index = i;
    moving.multi = body.multi.get();
    moving.link = body.parts[body.links[joint.child].part].index;
    if (joint.limit) {
      moving.limit = std::make_unique<btMultiBodyJointLimitConstraint>(
          body.multi.get(), moving.link, joint.limit->lower, joint.limit->upper);
      dynamics.addMultiBodyConstraint(moving.limit.get());
      moving.limit->finalizeMultiDof();
    }
    joints.push_back(std::move(moving));
  }
}

World::World(const scene::Physics& physics, double substep)
    : parts_(std::make_unique<Parts>(physics, substep)) {}
World::~World() = default;

void World::add(const scene::Entity& entity) {
  Parts& p = *parts_;
  p.bodies.push_back(build(entity, p.settings));
  Body& body = p.bodies.back();
  body.entity = p.bodies.size() - 1;
  body.first_link = p.link_count;
  p.link_count += body.links.size();
  const int number = static_cast<int>(body.entity);
  if (body.rigid) {
    body.rigid->setUserIndex(number);
    p.dynamics.addRigidBody(body.rigid.get());
  }
  if (body.drive) {
    p.driven.push_back(body.entity);
    if (entity.movable) p.dynamics.addConstraint(body.drive.get());
  }
  if (body.multi) p.dynamics.addMultiBody(body.multi.get());
  for (auto& collider : body.link_colliders) {
    const bool fixed = collider->isStaticObject();
    collider->setUserIndex(number);
    p.dynamics.addCollisionObject(
        collider.get(), fixed ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter,
        fixed ? btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter
              : btBroadphaseProxy::AllFilter);
  }
  p.add_joints(entity, body);
  for (auto& plugin : p.plugins) plugin->body_added(body);
}

void World::remove(std::size_t entity) {
  Parts& p = *parts_;
  Body& body = p.bodies[entity];
  for (auto& collider : body.link_colliders) wake_neighbours(*collider, p.dynamics);
  if (body.rigid) wake_neighbours(*body.rigid, p.dynamics);
  for (auto& plugin : p.plugins) plugin->body_removed(body);
  std::erase(p.driven, entity);
  std::erase_if(p.motors, [&](std::size_t motor) { return p.joints[motor].entity == entity; });
  for (MovingJoint& joint : p.joints) {
    if (joint.entity != entity) continue;
    p.detach(joint);
    const std::size_t index = joint.index;
    joint = {};
    joint.entity = entity;
    joint.index = index;
  }
  p.detach(body);
  // Without links: nothing acts on it, nothing is read of it.
  const Body gone = std::exchange(body, Body{});
  body.entity = entity;
  body.first_link = gone.first_link;
}

std::optional<std::size_t> World::overlapped_by(const scene::Entity& entity) const {
  const std::vector<PlacedCollider> candidates = placed_colliders(entity);
  std::optional<std::size_t> first;
  const btCollisionObjectArray& objects = parts_->dynamics.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const btCollisionObject& object = *objects[i];
    if (object.getUserIndex() < 0) continue;  // the floor
    const auto number = static_cast<std::size_t>(object.getUserIndex());
    if (first && *first <= number) continue;
    const PlacedCollider other = placed_collider(object);
    if (std::ranges::any_of(candidates, [&](const auto& each) { return overlaps(each, other); })) {
      first = number;
    }
  }
  return first;
}

JointIndex World::joint(std::size_t entity, std::size_t joint) const {
  std::size_t i = 0;
  while (parts_->joints[i].entity != entity || parts_->joints[i].index != joint) ++i;
  return {i};
}

void World::add_motor(JointIndex index, scene::JointMode mode, double max_impulse) {
  MovingJoint& joint = parts_->joints[index.value];
  joint.motor.mode = mode;
  joint.motor.max_impulse = max_impulse;
  if (mode == scene::JointMode::disabled) return;
  joint.motor.constraint =
      std::make_unique<btMultiBodyJointMotor>(joint.multi, joint.link, 0, 0, max_impulse);
  parts_->dynamics.addMultiBodyConstraint(joint.motor.constraint.get());
  joint.motor.constraint->finalizeMultiDof();
  parts_->motors.push_back(index.value);
}

void World::set_target(JointIndex joint, double target) {
  parts_->joints[joint.value].motor.target = target;
}

double World::position(JointIndex index) const {
  const MovingJoint& joint = parts_->joints[index.value];
  return joint.multi ? joint.multi->getJointPos(joint.link) : 0;
}

double World::velocity(JointIndex index) const {
  const MovingJoint& joint = parts_->joints[index.value];
  return joint.multi ? joint.multi->getJointVel(joint.link) : 0;
}

void World::set_velocity(std::size_t entity, double velocity, double angular_velocity) {
  Drive& drive = *parts_->bodies[entity].drive;
  drive.velocity = velocity;
  drive.angular_velocity = angular_velocity;
}

void World::set_turret(std::size_t entity, std::optional<double> speed) {
  Body& body = parts_->bodies[entity];
  body.drive->turret_follows = !speed;
  body.drive->turret_speed = speed.value_or(0);
}

double World::turret(std::size_t entity) const {
  return parts_->bodies[entity].drive->turret_angle;
}

void World::set_currents(std::span<const double> currents) {
  if (parts_->magnets) parts_->magnets->set_currents(currents);
}

void World::move(std::size_t entity, const math::Pose& pose) {
  physics::move(parts_->bodies[entity], pose, parts_->dynamics);
}

void World::step() {
  Parts& p = *parts_;
  p.stepped = p.bodies.size();
  for (int split = 0; split < p.splits; ++split) {
    for (auto& plugin : p.plugins) plugin->before_substep(p.bodies, p.length);
    for (const std::size_t motor : p.motors) {
      MovingJoint& joint = p.joints[motor];
      steer(joint, p.length, joint.motor.max_impulse / p.splits);
    }
    for (const std::size_t body : p.driven) p.bodies[body].drive->before_substep(p.length);
    p.dynamics.substep(p.length);
    for (const std::size_t body : p.driven) p.bodies[body].drive->after_substep(p.length);
  }
  for (const std::size_t body : p.driven) pose_turret(p.bodies[body]);
}

void World::read(world::State& state) const {
  for (std::size_t entity = 0; entity < parts_->bodies.size(); ++entity) {
    if (!parts_->bodies[entity].links.empty()) read(entity, state);  // not removed
  }
}

void World::read(std::size_t entity, world::State& state) const {
  Parts& p = *parts_;
  state.origins.resize(p.bodies.size());
  state.links.resize(p.link_count);
  auto& [motions, rotations, positions] = p.reading;
  const Body& body = p.bodies[entity];
  const bool stepped = entity < p.stepped;
  if (body.multi && stepped) body.multi->forwardKinematics(rotations, positions);
  body.motions(motions);
  for (std::size_t i = 0; i < body.links.size(); ++i) {
    const LinkBody& link = body.links[i];
    world::LinkState& out = state.links[body.first_link + i];
    out.pose = link.placed;
    if (stepped && link.moves) {
      out.pose = from_bullet(body.transform(link));
      out.pose.position -= out.pose.orientation * link.center_of_mass;
    }
    const Motion motion = body.motion(link, motions);
    out.angular_velocity = from_bullet(motion.angular_velocity);
    const math::Vector3 arm = out.pose.orientation * -link.center_of_mass;
    out.velocity = from_bullet(motion.velocity) + out.angular_velocity.cross(arm);
  }
  const math::Pose& reference = state.links[body.first_link + body.reference_link].pose;
  state.origins[entity] = stepped ? reference * body.origin_from_reference : body.placed;
}

World::Stiffness World::stiffest_bond() const {
  Stiffness stiffness{0, 0, parts_->length, magnetism::stiffest_product};
  if (!parts_->magnets) return stiffness;
  const Magnets::Stiffest stiffest = parts_->magnets->stiffest_bond(parts_->bodies);
  stiffness.entity = stiffest.entity;
  stiffness.product = stiffest.rate * parts_->length;
  return stiffness;
}

double World::energy() const {
  double total = 0;
  std::vector<Motion> motions;
  for (const Body& body : parts_->bodies) {
    if (body.links.empty()) continue;
    body.motions(motions);
    for (std::size_t i = 0; i < body.parts.size(); ++i) {
      const Part& part = body.parts[i];
      if (!part.moves) continue;
      const btTransform pose = part.transform();
      const btVector3 w = pose.getBasis().transpose() * motions[i].angular_velocity;
      total +=
          part.mass * (motions[i].velocity.length2() / 2 + parts_->gravity * pose.getOrigin().z());
      total += (to_bullet(part.inertia) * w).dot(w) / 2;
    }
  }
  return total;
}

}  // namespace ziggurat::physics
