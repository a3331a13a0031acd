#pragma once
// Sockets in folders that only this user can enter.

#include <list>
#include <string>

#include "posix/descriptor.h"
#include "processes/guardian.h"
#include "processes/private_folder.h"

namespace ziggurat::run {

class LocalEndpoints {
 public:
  /// @param guardian  removes what is left if this program is killed; null: none
  explicit LocalEndpoints(const processes::Guardian* guardian) : guardian_(guardian) {}
  /// Removes what is empty. The server has removed its sockets by then.
  ~LocalEndpoints() { release(); }
  LocalEndpoints(const LocalEndpoints&) = delete;
  LocalEndpoints& operator=(const LocalEndpoints&) = delete;

  /// The same as the destructor, for a program that ends without it.
  void release();

  /// For `ipc://*`: anywhere.
  std::string any();
  /// Endpoint of `serve` by default, at which clients of this user find it. Its folder is
  /// $XDG_RUNTIME_DIR/ziggurat, otherwise /tmp/ziggurat-UID, both with mode 0700. If another user
  /// has taken that name, it is any other. Removes the sockets of killed servers from it.
  /// @param scene  path of the scene file, whose name is part of the socket's
  std::string of_server(const std::string& scene);

 private:
  const processes::Guardian* guardian_;
  std::list<processes::PrivateFolder> folders_;
  std::string shared_;        ///< the folder of of_server()
  posix::Descriptor opened_;  ///< the same
};

}  // namespace ziggurat::run
