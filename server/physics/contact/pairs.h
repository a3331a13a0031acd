#pragma once
// One function per pair of shapes. All take the poses of the shapes' centres in the world and
// fill `out` with points no farther apart than `reach`.

#include "physics/contact/shapes.h"

namespace ziggurat::physics::contact {

void box_plane(const Box& a, const btTransform& pose_a, const btTransform& plane, btScalar reach,
               Contacts& out);
void cylinder_plane(const Cylinder& a, const btTransform& pose_a, const btTransform& plane,
                    btScalar reach, Contacts& out);
void sphere_plane(const Sphere& a, const btTransform& pose_a, const btTransform& plane,
                  btScalar reach, Contacts& out);

void sphere_sphere(const Sphere& a, const btTransform& pose_a, const Sphere& b,
                   const btTransform& pose_b, btScalar reach, Contacts& out);
void sphere_box(const Sphere& a, const btTransform& pose_a, const Box& b, const btTransform& pose_b,
                btScalar reach, Contacts& out);
void sphere_cylinder(const Sphere& a, const btTransform& pose_a, const Cylinder& b,
                     const btTransform& pose_b, btScalar reach, Contacts& out);

void box_box(const Box& a, const btTransform& pose_a, const Box& b, const btTransform& pose_b,
             btScalar reach, Contacts& out);

/// Cylinder against box or cylinder.
void cylinder_convex(const Cylinder& a, const btTransform& pose_a, const Shape& b,
                     const btTransform& pose_b, btScalar reach, Contacts& out);

/// The same contacts seen from the other side: normal turned round, points moved to the
/// surface of what was A.
void swap_sides(Contacts& contacts);

}  // namespace ziggurat::physics::contact
