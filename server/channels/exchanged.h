#pragma once
// Messages about exchange between entities at a tick: rays, detections of cameras, radio messages,
// contacts.

#include "channels/moment.h"
#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::channels {

// Each clears the message, whose memory is used again.
void fill(const Moment& moment, v1::Rays& rays);
void fill(const Moment& moment, v1::Detections& detections);
/// Without messages and packets: nothing was received.
void fill(const Moment& moment, v1::RadioTraffic& traffic);
void fill(const Moment& moment, v1::Contacts& contacts);

}  // namespace ziggurat::channels
