// SPDX-License-Identifier: MIT
#pragma once
// A small world with much of the state that worlds can have. It has a robot with an arm, a tag, a
// magnet, a battery, a radio and sensors with noise. Another magnet is beside it, and boxes fall on
// a floor.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "require.h"
#include "scene/additions.h"
#include "scene/reader.h"
#include "simulation/simulation.h"

namespace ziggurat::fuzz {

inline constexpr const char* small_world =
    R"(<argos><framework><experiment ticks_per_second="10" random_seed="3"/>
  </framework><controllers><external_controller id="c"><actuators>
  <joints implementation="default"><joint id="hinge" mode="velocity" max_impulse="20"/></joints>
  <radios implementation="default"/><tags implementation="default"/></actuators><sensors>
  <joints implementation="default"><joint id="hinge" mode="position"/></joints><radios implementation="default"/>
  <proximity implementation="default" noise_level="0.1"/><battery implementation="default"/>
  <positioning implementation="default" pos_noise_range="-0.1:0.1"/></sensors><params/></external_controller>
  </controllers><arena size="9,9,9"><prototype id="r" movable="true"><body position="1,0,0"/><links ref="base">
  <link id="base" geometry="box" size=".3,.3,.1" mass="1"/><link id="arm" geometry="box" size=".5,.1,.1" mass="1"/>
  </links><joints><joint id="hinge" type="revolute" axis="0,1,0"><parent link="base" position="0,0,.4"/>
  <child link="arm" position="-.25,0,0"/></joint></joints><devices>
  <radios medium="air"><radio id="rx" anchor="base" position="0,0,.1" range="9"/></radios>
  <tags medium="tags"><tag anchor="base" position="0,0,.1" orientation="0,0,0" observable_angle="80"
  side_length="0.04" payload="0"/></tags>
  <proximity_sensors><sensor anchor="base" offset="0.2,0,0.05" direction="1,0,0" range="0.4"/></proximity_sensors>
  <magnets><magnet id="m" passive_field="-100,0,0" anchor="base" offset="0,0,.05"/></magnets>
  <battery discharge_model="time" full_charge="40" factor="1"/></devices><controller config="c"/></prototype>
  <prototype id="m" movable="true"><body position="1.3,0,0"/><links ref="base"><link id="base" geometry="box"
  size=".1,.1,.1" mass="1"/></links><devices><magnets><magnet id="m" passive_field="-100,0,0" anchor="base"
  offset="0,0,.05"/></magnets></devices></prototype>
  <box id="low" size=".4,.4,.4" movable="true" mass="1"><body position="0,0,0"/></box>
  <box id="high" size=".2,.2,.2" movable="true" mass="1"><body position="0.05,0,0.42"/></box></arena>
  <physics_engines><dynamics3d id="d" iterations="2"><floor/><gravity g="9.8"/><magnetism max_distance="0.5"/>
  </dynamics3d></physics_engines><media><radio id="air"/><tag id="tags"/></media></argos>)";
inline constexpr const char* small_box =
    R"(<box id="new" size=".1,.1,.1" movable="true" mass="1"><body position="-1,-1,.2"/></box>)";

inline scene::ReadResult read_small_world() {
  scene::ReadResult read = scene::read_text(small_world, "small.argos");
  for (const auto& problem : read.problems) {
    std::fprintf(stderr, "%s\n", scene::to_string(problem).c_str());
  }
  require(read.ok());
  return read;
}

/// Changes valid bytes as the input says: each six bytes of it are one change. Most inputs so pass
/// the first checks of a format.
template <class Bytes>
Bytes edited(Bytes bytes, std::span<const std::uint8_t> edits) {
  for (std::size_t i = 0; i + 6 <= edits.size() && !bytes.empty(); i += 6) {
    std::uint32_t number = 0;
    std::memcpy(&number, edits.data() + i, 3);
    const std::size_t at = number % bytes.size();
    const std::uint8_t value = edits[i + 4], more = edits[i + 5];
    auto* data = reinterpret_cast<std::uint8_t*>(bytes.data());
    const std::size_t left = bytes.size() - at;
    switch (edits[i + 3] % 6) {
      case 0:
        data[at] = value;
        break;
      case 1:
        data[at] ^= static_cast<std::uint8_t>(1U << value % 8);
        break;
      case 2:  // a number of four or eight bytes
        std::memset(data + at, more & 1 ? 0xFF : 0, std::min<std::size_t>(left, more & 2 ? 8 : 4));
        data[at] = value;
        break;
      case 3:  // what stands elsewhere
        if (left > 16)
          std::memmove(data + at, data + (std::size_t{value} << 8 | more) % (bytes.size() - 8), 8);
        break;
      case 4:
        bytes.erase(
            bytes.begin() + static_cast<std::ptrdiff_t>(at),
            bytes.begin() + static_cast<std::ptrdiff_t>(at + std::min<std::size_t>(left, value)));
        break;
      default:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), value % 32, {});
        break;
    }
  }
  return bytes;
}

}  // namespace ziggurat::fuzz
