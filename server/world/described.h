// SPDX-License-Identifier: MIT
#pragma once
// Devices that describe themselves: the fields of a kind stand in its description, and messages,
// checks, hash, recordings and clients follow from it.

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "world/channel.h"
#include "world/mount.h"

namespace ziggurat::world {

/// Unit of a field that is a colour, 0xRRGGBB.
inline constexpr const char* color_unit = "0xRRGGBB";

/// A number that devices of a kind read, or that is told of each once.
struct DeviceField {
  const char* name;
  const char* unit = "";  ///< empty: a number without unit
};

/// A number that can be commanded.
struct DeviceCommand {
  const char* name;
  const char* unit = "";
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  double initial = 0;
  double released = 0;  ///< when the robot leaves
};

/// Description of a kind of device.
struct DeviceKind {
  const char* name;                                  ///< of its element in <sensors> or <actuators>
  std::initializer_list<DeviceField> readings = {};  ///< of a device, or of each of its rows
  std::initializer_list<DeviceCommand> commands = {};  ///< of a device
  std::initializer_list<DeviceField> properties = {};  ///< of a device
  std::size_t most_rows = 0;  ///< not 0: a device reads any number of rows up to this one

  bool is_list() const { return most_rows > 0; }
};

/// Readings of a device of a kind with rows.
struct DeviceRows {
  std::size_t width = 1;       ///< the number of the kind's readings
  std::vector<double> values;  ///< row after row

  std::size_t count() const { return values.size() / width; }
};

/// A device of such a kind, of a robot whose controller enables it.
struct DescribedDevice {
  const DeviceKind* kind = nullptr;
  std::string id;  ///< empty: it is known by its place
  Mount mount;
  std::vector<double> properties;  ///< one for each of the kind's
  Range readings;                  ///< into Observations::device_readings
  Range rows;                      ///< of a kind with rows: its place in Observations::device_rows
  Range commands;                  ///< into Commands::device_commands; empty: no actuator
  double sight = 0;                ///< it looks for LEDs no farther away [m]; 0: for none

  bool measures() const { return readings.count > 0 || rows.count > 0; }
};

}  // namespace ziggurat::world
