// SPDX-License-Identifier: MIT
// Each field of what is true at one tick is in its table. The compiler takes a second for it: here,
// not in each source that includes the tables.

#include "world/channel.h"
#include "world/commands.h"
#include "world/devices.h"
#include "world/state.h"

namespace ziggurat::world {

static_assert(lists_all_fields<Observations>(sensed),
              "list each field of Observations once in the table `sensed`");
static_assert(lists_all_fields<Commands>(commanded),
              "list each field of Commands once in the table `commanded`");
static_assert(lists_all_fields<State>(state_fields),
              "list each field of State once in the table `state_fields`");

}  // namespace ziggurat::world
