#pragma once
// Transport to a server of this machine, without ZeroMQ and its thread: a tick is one send and one
// receive.

#include <memory>
#include <string>

#include "transport.h"

namespace ziggurat {

/// ZMTP with mechanism NULL over a socket of the system, which is opened when there is a server.
/// @param endpoint  `ipc://path`
/// @param keys_are_missing  why a protected server is left
/// @throws std::invalid_argument if there can be no such path
std::unique_ptr<Transport> make_local_transport(const std::string& endpoint,
                                                const char* keys_are_missing);

}  // namespace ziggurat
