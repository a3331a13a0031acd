// SPDX-License-Identifier: MIT
#pragma once
// Addresses that the server listens at: `ipc://path` or `tcp://host:port`.

#include <stdexcept>
#include <string>

namespace ziggurat::network {

/// An endpoint that can't be used: one sentence with the endpoint, what is wrong and what would
/// be right.
class EndpointError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Checks the form of an endpoint, that an ipc path fits into 107 bytes, and that a tcp host is a
/// loopback address (127.0.0.0/8, [::1], localhost) unless `insecure`.
/// @throws EndpointError
void check_endpoint(const std::string& endpoint, bool insecure);

/// Whether a server accepts connections at this path.
bool is_listening(const std::string& path);

/// The path of the socket's file, which ZeroMQ leaves behind; empty if there is none.
/// @param endpoint  as configured; ZeroMQ removes the file of `ipc://*`
std::string file_of(const std::string& endpoint);

}  // namespace ziggurat::network
