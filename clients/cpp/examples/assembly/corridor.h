// SPDX-License-Identifier: MIT
#pragma once
// Who may work at the structure at the same time. A robot that places a block needs a corridor: the
// straight way from where it lines up with a side to where it stands when it lets the block go.
// Robots whose corridors are apart don't hinder each other. No robot can tell another its place, as
// they have no common frame; but each sees from where another stands, and what row of the rule
// table it says, which place that may be.

#include "geometry.h"
#include "rules.h"

namespace assembly {

struct Assembler;

/// From the robot's centre to a side when it lets the block go [m].
double distance_of(const Row& row);
/// Point at which a robot lines up with a side.
Point start_of(const Pose& side, const Row& row);
/// Whether the corridor to a side, its row of columns, is taken. Another robot works in it, is
/// lined up with it or stands at its start. A robot on its way to the side counts if it is so much
/// nearer that it will be there first.
/// @param own_distance  of this robot from there [m]
bool is_corridor_taken(const Assembler& self, const Pose& side, const Row& row,
                       double own_distance);
/// Asks for the corridor to a side; call it in every step. True when the robot may enter.
bool may_enter(Assembler& self, const Pose& side, const Row& row);

}  // namespace assembly
