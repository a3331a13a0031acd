#pragma once
// What passes between entities at a tick: rays, what cameras see, radio messages, contacts.

#include "channels/moment.h"
#include "ziggurat/v1/channels.pb.h"

namespace ziggurat::channels {

v1::Rays rays_of(const Moment& moment);
v1::Detections detections_of(const Moment& moment);
/// Without messages and packets: nothing was received.
v1::RadioTraffic radio_of(const Moment& moment);
v1::Contacts contacts_of(const Moment& moment);

}  // namespace ziggurat::channels
