#include "physics/bullet/core.h"

#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include <algorithm>

#include "physics/bullet/contacts.h"
#include "physics/bullet/dynamics.h"
#include "physics/bullet/joints.h"
#include "physics/bullet/mechanism.h"
#include "physics/bullet/move.h"
#include "physics/bullet/solver.h"
#include "physics/convert.h"
#include "physics/make_room.h"

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

/// Joints of a body with a coordinate, not yet in Bullet's world.
std::vector<MovingJoint> make_joints(const scene::Entity& entity, const Body& body) {
  std::vector<MovingJoint> made;
  for (std::size_t i = 0; i < entity.joints.size(); ++i) {
    const scene::Joint& joint = entity.joints[i];
    if (!scene::has_coordinate(joint.type)) continue;
    MovingJoint moving;
    moving.entity = body.entity;
    moving.index = i;
    moving.multi = body.mechanism->multi.get();
    moving.link = multi_index(body.links[joint.child].part);
    if (joint.limit) {
      moving.limit = std::make_unique<btMultiBodyJointLimitConstraint>(
          moving.multi, moving.link, joint.limit->lower, joint.limit->upper);
    }
    made.push_back(std::move(moving));
  }
  return made;
}

}  // namespace

/// The half-space z <= 0.
struct SweepsCore::Ground {
  explicit Ground(const scene::Surface& surface)
      : plane(btVector3(0, 0, 1), 0),
        body(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane)) {
    collider.shape = contact::HalfSpace{};
    collider.friction = surface.friction;
    collider.rolling_friction = surface.rolling_friction;
    body.setUserPointer(&collider);
  }
  btStaticPlaneShape plane;
  contact::Collider collider;
  btRigidBody body;
};

struct SweepsCore::Parts {
  explicit Parts(const scene::Physics& physics)
      : settings(physics),
        configuration(contact::construction_info()),
        dispatcher(&configuration),
        algorithms(contact::register_algorithms(dispatcher)),
        solver(physics.solver_iterations ? static_cast<int>(*physics.solver_iterations)
                                         : default_sweeps_per_body),
        dynamics(dispatcher, broadphase, solver, configuration) {
    configure(dynamics.getSolverInfo(), physics);
    gDeactivationTime = 0.5;  // the one global of Bullet that we set; the same for every world [s]
    dynamics.setGravity(btVector3(0, 0, 0));
  }

  void detach(MovingJoint& joint);
  void detach(Body& body);

  scene::Physics settings;

  // Destroyed from the end: the world before what it points to.
  std::unique_ptr<Ground> ground;
  std::vector<MovingJoint> joints;
  std::vector<std::size_t> motors;  // into joints
  std::vector<std::size_t> held;    // entities with a GroundHold
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  std::unique_ptr<btCollisionAlgorithmCreateFunc> algorithms;
  btDbvtBroadphase broadphase;
  Solver solver;
  Dynamics dynamics;
};

SweepsCore::SweepsCore(const scene::Physics& physics) : parts_(std::make_unique<Parts>(physics)) {}

SweepsCore::~SweepsCore() {
  if (parts_->ground) parts_->dynamics.removeRigidBody(&parts_->ground->body);
}

void SweepsCore::add_floor(const scene::Surface& surface) {
  parts_->ground = std::make_unique<Ground>(surface);
  parts_->dynamics.addRigidBody(&parts_->ground->body);
}

/// Takes it out of Bullet's world.
void SweepsCore::Parts::detach(MovingJoint& joint) {
  if (joint.limit) dynamics.removeMultiBodyConstraint(joint.limit.get());
  if (joint.motor.constraint) dynamics.removeMultiBodyConstraint(joint.motor.constraint.get());
}

Body SweepsCore::add(const scene::Entity& entity, std::size_t number) {
  Parts& p = *parts_;
  Body body = build(entity, p.settings, number);
  std::vector<MovingJoint> joints = make_joints(entity, body);
  make_room(p.joints, joints.size());
  make_room(p.held, 1);
  // From here on only Bullet allocates, which does not throw.
  Mechanism& mechanism = *body.mechanism;
  if (mechanism.rigid) p.dynamics.addRigidBody(mechanism.rigid.get());
  if (mechanism.hold) {
    p.held.push_back(number);
    p.dynamics.addConstraint(mechanism.hold.get());
  }
  if (mechanism.multi) p.dynamics.addMultiBody(mechanism.multi.get());
  for (auto& collider : mechanism.link_colliders) {
    const bool fixed = collider->isStaticObject();
    p.dynamics.addCollisionObject(
        collider.get(), fixed ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter,
        fixed ? btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::StaticFilter
              : btBroadphaseProxy::AllFilter);
  }
  for (MovingJoint& joint : joints) {
    if (joint.limit) {
      p.dynamics.addMultiBodyConstraint(joint.limit.get());
      joint.limit->finalizeMultiDof();
    }
    p.joints.push_back(std::move(joint));
  }
  return body;
}

/// The same, with its joints.
void SweepsCore::Parts::detach(Body& body) {
  std::erase(held, body.entity);
  std::erase_if(motors, [&](std::size_t motor) { return joints[motor].entity == body.entity; });
  for (MovingJoint& joint : joints) {
    if (joint.entity == body.entity) detach(joint);
  }
  Mechanism& mechanism = *body.mechanism;
  if (mechanism.hold) dynamics.removeConstraint(mechanism.hold.get());
  for (auto& collider : mechanism.link_colliders) dynamics.removeCollisionObject(collider.get());
  if (mechanism.multi) dynamics.removeMultiBody(mechanism.multi.get());
  if (mechanism.rigid) dynamics.removeRigidBody(mechanism.rigid.get());
}

void SweepsCore::remove(Body& body) {
  Parts& p = *parts_;
  Mechanism& mechanism = *body.mechanism;
  for (auto& collider : mechanism.link_colliders) wake_neighbours(*collider, p.dynamics);
  if (mechanism.rigid) wake_neighbours(*mechanism.rigid, p.dynamics);
  p.detach(body);
  for (MovingJoint& joint : p.joints) {
    if (joint.entity != body.entity) continue;
    const std::size_t index = joint.index;
    joint = {};
    joint.entity = body.entity;
    joint.index = index;
  }
  body.mechanism.reset();
}

void SweepsCore::take_back(Body& body) {
  Parts& p = *parts_;
  p.detach(body);
  std::erase_if(p.joints, [&](const MovingJoint& joint) { return joint.entity == body.entity; });
  body.mechanism.reset();
}

void SweepsCore::move(Body& body) {
  physics::move(*body.mechanism, to_bullet(base_pose(body)), parts_->dynamics);
}

std::optional<std::size_t> SweepsCore::overlapped_by(std::span<const PlacedCollider> colliders,
                                                     std::size_t except) const {
  std::optional<std::size_t> first;
  const btCollisionObjectArray& objects = parts_->dynamics.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i) {
    const contact::Collider& collider = contact::collider_of(*objects[i]);
    if (collider.entity == contact::Collider::floor || collider.entity == except) continue;
    if (first && *first <= collider.entity) continue;
    const PlacedCollider other{collider.shape, objects[i]->getWorldTransform()};
    if (std::ranges::any_of(colliders, [&](const auto& each) { return overlaps(each, other, resting_depth); })) {
      first = collider.entity;
    }
  }
  return first;
}

JointIndex SweepsCore::joint(std::size_t entity, std::size_t joint) const {
  std::size_t i = 0;
  while (parts_->joints[i].entity != entity || parts_->joints[i].index != joint) ++i;
  return {i};
}

void SweepsCore::add_motor(JointIndex index, scene::JointMode mode, double max_impulse) {
  MovingJoint& joint = parts_->joints[index.value];
  joint.motor.mode = mode;
  joint.motor.max_impulse = max_impulse;
  if (mode == scene::JointMode::disabled) return;
  joint.motor.constraint =
      std::make_unique<btMultiBodyJointMotor>(joint.multi, joint.link, 0, 0, max_impulse);
  parts_->motors.push_back(index.value);
  parts_->dynamics.addMultiBodyConstraint(joint.motor.constraint.get());
  joint.motor.constraint->finalizeMultiDof();
}

void SweepsCore::set_target(JointIndex joint, double target) {
  parts_->joints[joint.value].motor.target = target;
}

double SweepsCore::position(JointIndex index) const {
  const MovingJoint& joint = parts_->joints[index.value];
  return joint.multi ? joint.multi->getJointPos(joint.link) : 0;
}

double SweepsCore::velocity(JointIndex index) const {
  const MovingJoint& joint = parts_->joints[index.value];
  return joint.multi ? joint.multi->getJointVel(joint.link) : 0;
}

void SweepsCore::substep(std::span<Body> bodies, double length, int splits) {
  Parts& p = *parts_;
  for (const std::size_t motor : p.motors) {
    MovingJoint& joint = p.joints[motor];
    steer(joint, length, joint.motor.max_impulse / splits);
  }
  for (const std::size_t entity : p.held) {
    bodies[entity].mechanism->hold->set(*bodies[entity].ground);
  }
  p.dynamics.substep(length);
}

void SweepsCore::contacts(std::vector<LinkContact>& out) const { collect(parts_->dispatcher, out); }

}  // namespace ziggurat::physics
