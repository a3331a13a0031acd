#include "devices/device_table.h"

#include "devices/joints.h"

namespace ziggurat::lua {

std::span<const DeviceKind> device_kinds() {
  static constexpr DeviceKind kinds[] = {
      {"joints", has_joints, push_joints, refresh_joints},
  };
  return kinds;
}

}  // namespace ziggurat::lua
