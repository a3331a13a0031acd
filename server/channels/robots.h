#pragma once
// Readings and commands of a robot, as in a session of its own.

#include "channels/moment.h"
#include "wire/roster.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::channels {

// Each clears the message, whose memory is used again.

/// Pictures are left out: they have channels of their own.
void fill(const wire::Roster& robot, const Moment& moment, v1::Observation& to);

/// All that it wants now, and the messages that its radios are about to send.
void fill(const wire::Roster& robot, const world::Layout& layout, const Moment& moment,
          v1::Command& to);

}  // namespace ziggurat::channels
