// SPDX-License-Identifier: MIT
#pragma once
// Messages about exchange between entities at a tick: rays, detections of cameras, radio messages,
// contacts, readings and commands of a robot as in a session of its own.

#include "channels/moment.h"
#include "wire/roster.h"
#include "ziggurat/v1/channels.pb.h"
#include "ziggurat/v1/protocol.pb.h"

namespace ziggurat::channels {

// Each clears the message, whose memory is used again.
void fill(const Moment& moment, v1::Rays& rays);
void fill(const Moment& moment, v1::Detections& detections);
/// Without messages and packets: nothing was received.
void fill(const Moment& moment, v1::RadioTraffic& traffic);
void fill(const Moment& moment, v1::Contacts& contacts);

/// Pictures are left out: they have channels of their own.
void fill(const wire::Roster& robot, const Moment& moment, v1::Observation& to);

/// All that it wants now, and the messages that its radios are about to send.
void fill(const wire::Roster& robot, const world::Layout& layout, const Moment& moment,
          v1::Command& to);

}  // namespace ziggurat::channels
