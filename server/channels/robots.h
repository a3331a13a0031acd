#pragma once
// What a robot senses and wants, as in a session of its own.

#include "channels/moment.h"
#include "wire/roster.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::channels {

/// Pictures are left out: they have channels of their own.
v1::Observation observation_of(const wire::Roster& robot, const Moment& moment);

/// All that it wants now, and the messages that its radios are about to send.
v1::Command command_of(const wire::Roster& robot, const world::Layout& layout,
                       const Moment& moment);

}  // namespace ziggurat::channels
