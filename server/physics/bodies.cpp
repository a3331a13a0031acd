#include "physics/bodies.h"

#include <algorithm>
#include <cmath>

#include "physics/assembly.h"
#include "physics/convert.h"
#include "physics/geometry.h"
#include "physics/turning_magnets.h"

namespace ziggurat::physics {
namespace {

using math::Pose;

LinkBody link_body(const scene::Link& link, bool moves, const Pose& placed) {
  LinkBody body;
  body.moves = moves;
  body.mass = link.mass;
  body.inertia = inertia(link.geometry, link.mass);
  body.center_of_mass = center_of_mass(link.geometry);
  body.half_extents = half_extents(link.geometry);
  body.damping = link.damping;
  body.placed = placed;
  return body;
}

/// Gives a collision object its shape and surface.
void furnish(Body& body, btCollisionObject& object, const scene::Link& link,
             const btTransform& transform) {
  body.shapes.push_back(bullet_shape(link.geometry));
  body.colliders.push_back(std::make_unique<contact::Collider>());
  contact::Collider& collider = *body.colliders.back();
  collider.shape = contact_shape(link.geometry);
  collider.friction = link.surface.friction;
  collider.rolling_friction = link.surface.rolling_friction;
  collider.previous = transform;
  object.setCollisionShape(body.shapes.back().get());
  object.setUserPointer(&collider);
  object.setWorldTransform(transform);
}

/// A single body slower than this for half a second sleeps until something touches it.
constexpr double sleeping_velocity = 4e-3;         // [m/s]
constexpr double sleeping_angular_velocity = 0.4;  // [rad/s]

/// The plane that an entity stands on, if there is one.
const scene::Plane* plane_of(const scene::Entity& entity, const scene::Physics& physics) {
  constexpr double tolerance = 1e-6;  // [m]
  for (const scene::Plane& plane : physics.planes) {
    if (std::abs(entity.pose.position.z() - plane.elevation) < tolerance) return &plane;
  }
  return nullptr;
}

/// What holds a body to the ground, unless it is loose.
std::optional<scene::Traction> traction_of(const scene::Entity& entity,
                                           const scene::Physics& physics) {
  if (!entity.movable || entity.traction) return entity.traction;
  if (entity.kind == scene::EntityKind::prototype) return std::nullopt;
  const scene::Plane* plane = physics.flat ? plane_of(entity, physics) : nullptr;
  if (!plane) return std::nullopt;
  return entity.kind == scene::EntityKind::box ? plane->box : plane->cylinder;
}

/// Frames without body move with the first link.
void add_frames(Body& body, const scene::Entity& entity, const std::vector<Pose>& placed) {
  const Pose into = math::inverse(placed[0] * Pose{body.links[0].center_of_mass,
                                                   math::Quaternion::Identity()});
  for (std::size_t i = 1; i < entity.links.size(); ++i) {
    LinkBody frame = link_body(entity.links[i], true, placed[i]);
    frame.rigid = body.rigid.get();
    frame.carrier = 0;
    frame.in_carrier = to_bullet(into * placed[i]);
    body.links.push_back(frame);
  }
  body.turret = entity.turret;
}

/// A body with traction stays upright, and keeps its height on a plane.
void add_drive(Body& body, const scene::Entity& entity, const scene::Physics& physics) {
  const auto traction = traction_of(entity, physics);
  if (!traction) return;
  body.colliders[0]->rolls = true;
  body.drive = std::make_unique<Drive>(*body.rigid, *traction);
  if (!entity.movable) return;
  body.rigid->setFlags(0);  // no gyroscopic torque: it does not tilt
  body.rigid->setAngularFactor(btVector3(0, 0, 1));
  if (plane_of(entity, physics)) body.rigid->setLinearFactor(btVector3(1, 1, 0));
  if (entity.axle_length) body.rigid->setActivationState(DISABLE_DEACTIVATION);
}

void build_rigid(Body& body, const scene::Entity& entity, const std::vector<Pose>& placed,
                 const scene::Physics& physics) {
  const scene::Link& link = entity.links[0];
  LinkBody part = link_body(link, entity.movable, placed[0]);
  const btTransform transform =
      to_bullet(placed[0] * Pose{part.center_of_mass, math::Quaternion::Identity()});
  btRigidBody::btRigidBodyConstructionInfo info(
      entity.movable ? link.mass : 0, nullptr, nullptr,
      entity.movable ? to_bullet(part.inertia) : btVector3(0, 0, 0));
  info.m_startWorldTransform = transform;
  body.rigid = std::make_unique<btRigidBody>(info);
  furnish(body, *body.rigid, link, transform);
  body.rigid->setSleepingThresholds(sleeping_velocity, sleeping_angular_velocity);
  part.rigid = body.rigid.get();
  body.links.push_back(part);
  add_frames(body, entity, placed);
  add_drive(body, entity, physics);
}

/// A multi-body's links must be numbered from the root outwards; joints already are. Carried
/// links have their carrier's number.
void number_links(std::vector<LinkBody>& links, const scene::Entity& entity) {
  int next = 0;
  for (const scene::Joint& joint : entity.joints) {
    LinkBody& child = links[joint.child];
    if (child.carrier == LinkBody::carries_itself) child.index = next++;
  }
  for (LinkBody& link : links) {
    if (link.carrier != LinkBody::carries_itself) link.index = links[link.carrier].index;
  }
}

void set_up_joint(btMultiBody& multi, int index, const scene::Joint& joint, const LinkBody& parent,
                  const LinkBody& child, int parent_index) {
  const btVector3 inertia = to_bullet(child.inertia);
  // Bullet's rotation takes the parent's coordinates to the child's.
  const btQuaternion rotation = to_bullet(
      math::Quaternion(joint.child_frame.orientation * joint.parent_frame.orientation.conjugate()));
  const btVector3 to_pivot =
      to_bullet(math::Vector3(joint.parent_frame.position - parent.center_of_mass));
  const btVector3 from_pivot =
      to_bullet(math::Vector3(child.center_of_mass - joint.child_frame.position));
  const btVector3 axis = to_bullet(joint.axis);
  switch (joint.type) {
    case scene::JointType::fixed:
      multi.setupFixed(index, child.mass, inertia, parent_index, rotation, to_pivot, from_pivot);
      break;
    case scene::JointType::spherical:
      multi.setupSpherical(index, child.mass, inertia, parent_index, rotation, to_pivot, from_pivot,
                           true);
      break;
    case scene::JointType::prismatic:
      multi.setupPrismatic(index, child.mass, inertia, parent_index, rotation, axis, to_pivot,
                           from_pivot, true);
      break;
    case scene::JointType::revolute:
      multi.setupRevolute(index, child.mass, inertia, parent_index, rotation, axis, to_pivot,
                          from_pivot, true);
      break;
  }
}

void add_link_colliders(Body& body, const scene::Entity& entity) {
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    const LinkBody& part = body.links[i];
    if (!entity.links[i].collides || part.carrier != LinkBody::carries_itself) continue;
    auto collider = std::make_unique<btMultiBodyLinkCollider>(body.multi.get(), part.index);
    furnish(body, *collider, entity.links[i], part.transform());
    if (part.index < 0) {
      body.multi->setBaseCollider(collider.get());
      if (!entity.movable) collider->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    } else {
      body.multi->getLink(part.index).m_collider = collider.get();
    }
    if (part.moves) collider->setActivationState(DISABLE_DEACTIVATION);
    body.link_colliders.push_back(std::move(collider));
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

void build_multi(Body& body, const scene::Entity& entity, const std::vector<Pose>& placed,
                 bool magnetism) {
  for (std::size_t i = 0; i < entity.links.size(); ++i) {
    const bool moves = entity.movable || i != entity.reference_link;
    body.links.push_back(link_body(entity.links[i], moves, placed[i]));
  }
  if (magnetism) carry_turning_magnets(body.links, entity, placed);
  number_links(body.links, entity);
  const LinkBody& base = body.links[entity.reference_link];
  const auto carried =
      std::count_if(body.links.begin(), body.links.end(),
                    [](const LinkBody& link) { return link.carrier != LinkBody::carries_itself; });
  body.multi =
      std::make_unique<btMultiBody>(static_cast<int>(entity.joints.size() - carried), base.mass,
                                    to_bullet(base.inertia), !entity.movable, false);
  btMultiBody& multi = *body.multi;
  for (LinkBody& part : body.links) part.multi = &multi;
  for (const scene::Joint& joint : entity.joints) {
    const LinkBody& child = body.links[joint.child];
    if (child.carrier != LinkBody::carries_itself) continue;
    set_up_joint(multi, child.index, joint, body.links[joint.parent], child,
                 body.links[joint.parent].index);
  }
  multi.finalizeMultiDof();
  multi.setHasSelfCollision(false);
  multi.setCanSleep(false);
  multi.setUseGyroTerm(true);
  // Bullet's own damping is the dialect's law; where links differ our plug-in applies it.
  const scene::Damping damping = same_damping(entity) ? entity.links[0].damping : scene::Damping{};
  multi.setLinearDamping(damping.linear);
  multi.setAngularDamping(damping.angular);
  if (same_damping(entity)) {
    for (LinkBody& part : body.links) part.damping = {};
  }
  multi.setMaxAppliedImpulse(1e6);
  multi.setMaxCoordinateVelocity(1e6);
  multi.setBaseWorldTransform(
      to_bullet(base.placed * Pose{base.center_of_mass, math::Quaternion::Identity()}));
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> positions;
  multi.forwardKinematics(rotations, positions);
  add_link_colliders(body, entity);
}

/// A prototype of one link costs less than half as a rigid body, and nothing while it sleeps.
/// With magnets it stays a multi-body: stacks of magnets come to rest only in those.
bool is_single_body(const scene::Entity& entity) {
  switch (entity.kind) {
    case scene::EntityKind::box:
    case scene::EntityKind::cylinder:
      return true;
    case scene::EntityKind::prototype:
      return entity.links.size() == 1 && entity.links[0].collides && entity.devices.magnets.empty();
    default:
      return false;
  }
}

}  // namespace

btTransform LinkBody::transform() const {
  btTransform pose = rigid ? rigid->getWorldTransform() : multi->getBaseWorldTransform();
  if (index >= 0) {
    // Bullet moves colliders with each substep, the cached pose only when the next one begins.
    const btMultibodyLink& link = multi->getLink(index);
    pose = link.m_collider ? link.m_collider->getWorldTransform() : link.m_cachedWorldTransform;
  }
  if (carrier == carries_itself) return pose;
  return pose * btTransform(to_bullet(turn) * in_carrier.getRotation(), in_carrier.getOrigin());
}

void LinkBody::apply_force(const btVector3& force) const {
  if (rigid) {
    rigid->applyCentralForce(force);
  } else if (index < 0) {
    multi->addBaseForce(force);
  } else {
    multi->addLinkForce(index, force);
  }
}

void LinkBody::apply_torque(const btVector3& torque) const {
  if (rigid) {
    rigid->applyTorque(torque);
  } else if (index < 0) {
    multi->addBaseTorque(torque);
  } else {
    multi->addLinkTorque(index, torque);
  }
}

void Body::motions(std::vector<Motion>& out) const {
  out.resize(links.size());
  if (rigid) {
    const btTransform& pose = rigid->getWorldTransform();
    for (std::size_t i = 0; i < links.size(); ++i) {
      const btVector3 arm = links[i].transform().getOrigin() - pose.getOrigin();
      out[i] = {rigid->getVelocityInLocalPoint(arm),
                rigid->getAngularVelocity() + pose.getBasis().getColumn(2) * links[i].spin};
    }
    return;
  }
  // Bullet's tree velocities come in each link's own frame, the base first.
  const int count = multi->getNumLinks() + 1;
  btAlignedObjectArray<btVector3> omega, velocity;
  omega.resize(count);
  velocity.resize(count);
  multi->compTreeLinkVelocities(&omega[0], &velocity[0]);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const LinkBody& link = links[i];
    const bool carried = link.carrier != LinkBody::carries_itself;
    const btMatrix3x3 basis = (carried ? links[link.carrier] : link).transform().getBasis();
    out[i] = {basis * velocity[link.index + 1], basis * omega[link.index + 1]};
    if (carried) {
      out[i].velocity += out[i].angular_velocity.cross(basis * link.in_carrier.getOrigin());
    }
  }
}

Body build(const scene::Entity& entity, const scene::Physics& physics) {
  Body body;
  body.reference_link = entity.reference_link;
  body.placed = entity.pose;
  body.magnets = entity.devices.magnets;
  body.origin_from_reference = math::inverse(entity.links[entity.reference_link].offset);
  std::vector<Pose> placed = assemble(entity);
  for (Pose& pose : placed) pose = entity.pose * pose;
  if (is_single_body(entity) || entity.traction) {
    build_rigid(body, entity, placed, physics);
  } else {
    build_multi(body, entity, placed, physics.magnetism.has_value());
  }
  return body;
}

}  // namespace ziggurat::physics
