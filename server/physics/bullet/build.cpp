// Builds an entity's bodies in Bullet.

#include "physics/build.h"
#include "physics/bullet/mechanism.h"
#include "physics/convert.h"
#include "physics/shape.h"

namespace ziggurat::physics {
namespace {

using math::Pose;

/// Gives a collision object its shape and surface.
void add_shape(const Body& body, std::size_t number, const scene::Link& link,
               const btTransform& transform, btCollisionObject& object) {
  Mechanism& mechanism = *body.mechanism;
  mechanism.shapes.push_back(bullet_shape(link.geometry));
  mechanism.colliders.push_back(std::make_unique<contact::Collider>());
  contact::Collider& collider = *mechanism.colliders.back();
  collider.entity = body.entity;
  collider.link = number;
  collider.shape = contact_shape(link.geometry);
  collider.friction = link.surface.friction;
  collider.rolling_friction = link.surface.rolling_friction;
  collider.previous = transform;
  object.setCollisionShape(mechanism.shapes.back().get());
  object.setUserPointer(&collider);
  object.setWorldTransform(transform);
}

/// A single body slower than this for half a second sleeps until something touches it.
constexpr double sleeping_velocity = 4e-3;         // [m/s]
constexpr double sleeping_angular_velocity = 0.4;  // [rad/s]

/// A body with traction stays upright, and keeps its height on a plane.
void hold_to_ground(Body& body, const scene::Entity& entity, const scene::Physics& physics) {
  if (!body.ground) return;
  Mechanism& mechanism = *body.mechanism;
  mechanism.colliders[0]->rolls = true;
  if (!entity.movable) return;
  btRigidBody& rigid = *mechanism.rigid;
  mechanism.hold = std::make_unique<GroundHold>(rigid);
  rigid.setFlags(0);  // no gyroscopic torque: it does not tilt
  rigid.setAngularFactor(btVector3(0, 0, 1));
  if (plane_of(entity, physics)) rigid.setLinearFactor(btVector3(1, 1, 0));
  if (entity.axle_length) rigid.setActivationState(DISABLE_DEACTIVATION);
}

void build_rigid(Body& body, const scene::Entity& entity, const scene::Physics& physics) {
  const scene::Link& link = entity.links[0];
  const LinkBody& shape = body.links[0];
  const btTransform transform = to_bullet(shape.placed * shape.center);
  btRigidBody::btRigidBodyConstructionInfo info(
      entity.movable ? link.mass : 0, nullptr, nullptr,
      entity.movable ? to_bullet(shape.inertia) : btVector3(0, 0, 0));
  info.m_startWorldTransform = transform;
  body.mechanism->rigid = std::make_unique<btRigidBody>(info);
  btRigidBody& rigid = *body.mechanism->rigid;
  add_shape(body, 0, link, transform, rigid);
  rigid.setSleepingThresholds(sleeping_velocity, sleeping_angular_velocity);
  hold_to_ground(body, entity, physics);
}

void set_up_joint(Body& body, const scene::Joint& joint) {
  const LinkBody& parent = body.links[joint.parent];
  const LinkBody& child = body.links[joint.child];
  const Part& part = body.parts[child.part];
  const Pose pivot_in_parent = parent.frame_in_part() * joint.parent_frame;
  const Pose child_frame = child.frame_in_part();
  const Pose pivot = child_frame * joint.child_frame;
  const btVector3 inertia = to_bullet(part.inertia);
  // Bullet's rotation takes the parent's coordinates to the child's.
  const btQuaternion rotation =
      to_bullet(math::Quaternion(pivot.orientation * pivot_in_parent.orientation.conjugate()));
  const btVector3 to_pivot = to_bullet(pivot_in_parent.position);
  const btVector3 from_pivot = to_bullet(math::Vector3(-pivot.position));
  const btVector3 axis = to_bullet(math::Vector3(child_frame.orientation * joint.axis));
  const int index = multi_index(child.part), parent_index = multi_index(parent.part);
  btMultiBody& multi = *body.mechanism->multi;
  switch (joint.type) {
    case scene::JointType::fixed:
      break;  // welded
    case scene::JointType::spherical:
      multi.setupSpherical(index, part.mass, inertia, parent_index, rotation, to_pivot, from_pivot,
                           true);
      break;
    case scene::JointType::prismatic:
      multi.setupPrismatic(index, part.mass, inertia, parent_index, rotation, axis, to_pivot,
                           from_pivot, true);
      break;
    case scene::JointType::revolute:
      multi.setupRevolute(index, part.mass, inertia, parent_index, rotation, axis, to_pivot,
                          from_pivot, true);
      break;
  }
}

/// Bullet moves the first collider of each part, we the others.
void lead(btMultiBody& multi, int index, LinkCollider& collider) {
  btMultiBodyLinkCollider* leader =
      index < 0 ? multi.getBaseCollider() : multi.getLink(index).m_collider;
  if (leader) {
    collider.follow(*link_collider(leader));
  } else if (index < 0) {
    multi.setBaseCollider(&collider);
  } else {
    multi.getLink(index).m_collider = &collider;
  }
}

void add_link_colliders(Body& body, const scene::Entity& entity) {
  Mechanism& mechanism = *body.mechanism;
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    const LinkBody& link = body.links[i];
    if (!entity.links[i].collides || link.carrier != LinkBody::carries_itself) continue;
    const int index = multi_index(link.part);
    auto collider =
        std::make_unique<LinkCollider>(mechanism.multi.get(), index, to_bullet(link.in_part));
    const btTransform part_pose = mechanism.transform(link.part);
    collider->setWorldTransform(part_pose);
    collider->note();
    lead(*mechanism.multi, index, *collider);
    add_shape(body, i, entity.links[i], part_pose * to_bullet(link.in_part), *collider);
    if (body.parts[link.part].moves) {
      collider->setActivationState(DISABLE_DEACTIVATION);
    } else {
      collider->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    }
    mechanism.link_colliders.push_back(std::move(collider));
  }
}

bool same_damping(const scene::Entity& entity) {
  for (const scene::Link& link : entity.links) {
    if (link.damping.linear != entity.links[0].damping.linear ||
        link.damping.angular != entity.links[0].damping.angular) {
      return false;
    }
  }
  return true;
}

/// Bullet's own damping is the dialect's law; where links differ our plug-in applies it.
void set_damping(Body& body, const scene::Entity& entity) {
  if (!same_damping(entity)) return;
  body.mechanism->multi->setLinearDamping(entity.links[0].damping.linear);
  body.mechanism->multi->setAngularDamping(entity.links[0].damping.angular);
  for (LinkBody& link : body.links) link.damping = {};
}

void build_multi(Body& body, const scene::Entity& entity) {
  const Part& base = body.parts[0];
  body.mechanism->multi =
      std::make_unique<btMultiBody>(static_cast<int>(body.parts.size()) - 1, base.mass,
                                    to_bullet(base.inertia), !entity.movable, false);
  btMultiBody& multi = *body.mechanism->multi;
  for (const scene::Joint& joint : entity.joints) {
    if (body.links[joint.child].part != body.links[joint.parent].part) set_up_joint(body, joint);
  }
  multi.finalizeMultiDof();
  multi.setHasSelfCollision(false);
  multi.setCanSleep(false);
  multi.setUseGyroTerm(true);
  multi.setLinearDamping(0);
  multi.setAngularDamping(0);
  set_damping(body, entity);
  multi.setMaxAppliedImpulse(1e6);
  multi.setMaxCoordinateVelocity(1e6);
  multi.setBaseWorldTransform(to_bullet(base_pose(body)));
  body.mechanism->update_poses();
  add_link_colliders(body, entity);
}

}  // namespace

Body build(const scene::Entity& entity, const scene::Physics& physics, std::size_t entity_number) {
  Body body = make_body(entity, physics, entity_number);
  body.mechanism = std::make_unique<Mechanism>();
  if (is_single_part(entity)) {
    build_rigid(body, entity, physics);
  } else {
    build_multi(body, entity);
  }
  return body;
}

}  // namespace ziggurat::physics
