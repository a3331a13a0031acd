// SPDX-License-Identifier: MIT
#pragma once
// Sockets in folders that only this user can enter.

#include <list>
#include <string>

#include "processes/guardian.h"
#include "processes/private_folder.h"

namespace ziggurat::run {

class LocalEndpoints {
 public:
  /// @param guardian  removes what is left if this program is killed; null: none
  explicit LocalEndpoints(const processes::Guardian* guardian) : guardian_(guardian) {}

  /// The same as the destructor, for a program that ends without it.
  void release() { folders_.clear(); }

  /// For `ipc://*`: in a folder of its own.
  std::string any();
  /// Endpoint of `serve` by default, at which clients of this user find it. Its folder is
  /// $XDG_RUNTIME_DIR/ziggurat, otherwise /tmp/ziggurat-UID, both with mode 0700. If another user
  /// has taken that name, it is any other. Removes the sockets of killed servers from it.
  /// @param scene  path of the scene file, whose name is part of the socket's
  std::string of_server(const std::string& scene);

 private:
  const processes::Guardian* guardian_;
  std::list<processes::PrivateFolder> folders_;
};

}  // namespace ziggurat::run
