// SPDX-License-Identifier: MIT
#pragma once
// A socket that listens at an endpoint.

#include <string>

#include "posix/descriptor.h"

namespace ziggurat::network {

class Listener {
 public:
  /// @param endpoint  as check_endpoint() allows it; tcp port `*` or 0 = any free one
  /// @throws EndpointError
  explicit Listener(const std::string& endpoint);
  /// Removes the socket's file.
  ~Listener();
  Listener(Listener&&) = default;
  Listener& operator=(Listener&&) = default;

  /// Wildcards resolved.
  const std::string& endpoint() const { return endpoint_; }
  int number() const { return descriptor_.number(); }
  /// A client that has connected; not open if there is none, errno then says why.
  posix::Descriptor accept() const;

 private:
  void listen_at_path(const std::string& endpoint, std::string path);
  void listen_at_address(const std::string& endpoint, const std::string& address);

  posix::Descriptor descriptor_;
  std::string endpoint_;
  std::string file_, folder_;  // to be removed; may be empty
  bool is_tcp_ = false;
};

}  // namespace ziggurat::network
