// SPDX-License-Identifier: MIT
#pragma once
// Requests of viewers, passed from the thread that serves them to the thread of the run.

#include <atomic>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "channels/channel.h"
#include "posix/descriptor.h"
#include "view/messages.h"

namespace ziggurat::view {

class ViewerRequests {
 public:
  /// @throws std::system_error
  ViewerRequests();

  // On the thread that serves viewers.

  void add_viewer(std::uint64_t viewer);
  void remove_viewer(std::uint64_t viewer);
  /// @param wanted  ids of channels that any viewer subscribes to, ascending
  /// @param fresh  of these: without subscriber before
  /// @param kinds  of those that are wanted
  void set_wanted(std::vector<std::uint32_t> wanted, std::vector<std::uint32_t> fresh,
                  channels::Kinds kinds);
  void add_call(ViewerCall call);
  void add_parameter(Parameter parameter);

  // On the thread of the run.

  /// Readable when there is something new that was not taken.
  int descriptor() const { return wake_.number(); }
  bool has_viewers() const { return viewer_count_ > 0; }
  bool has_changes() const { return has_changes_; }

  struct Changes {
    std::vector<std::uint32_t> wanted;  ///< all of now
    std::vector<std::uint32_t> fresh;   ///< since the last call
    channels::Kinds kinds;              ///< of those that are wanted now
    std::vector<ViewerCall> calls;
    std::vector<Parameter> parameters;
  };
  Changes take();
  bool is_connected(std::uint64_t viewer) const;

 private:
  void wake();

  posix::Descriptor wake_;
  std::atomic<std::size_t> viewer_count_ = 0;
  std::atomic<bool> has_changes_ = false;
  mutable std::mutex mutex_;  // of all below
  Changes changes_;
  std::set<std::uint64_t> viewers_;
};

}  // namespace ziggurat::view
