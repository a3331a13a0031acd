// SPDX-License-Identifier: MIT
// A document with every element that a scene may have, each in all of its variants. It is full of
// faults: an element is asked for all of its attributes though it has none.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <span>

#include "scene/draft.h"
#include "scene/reader.h"
#include "scene/vocabulary.h"

namespace ziggurat::scene {
namespace {

/// Before the devices of a controller.
constexpr std::string_view beginning = R"(<argos-configuration>
<parameters/>
<include/>
<framework><experiment/><run/><system/><profiling/></framework>
<director id="d"><params/></director>
<loop_functions script="s"><params/></loop_functions>
<physics_engines>
  <dynamics3d><floor/><gravity/><magnetism/></dynamics3d>
  <dynamics2d><friction/></dynamics2d>
  <pointmass3d/>
</physics_engines>
)";

/// Devices of a controller with what they may have in them; a later element replaces an empty one.
constexpr std::string_view actuators_with_parts = "<joints><joint/></joints>";
constexpr std::string_view sensors_with_parts = R"(
<joints><joint/></joints>
<cameras><camera><led_detector/><directional_led_detector/><tag_detector/></camera></cameras>
<imus><imu/></imus>
<contact_sensors><contact_sensor/></contact_sensors>
)";

/// Parts of entities.
constexpr std::string_view prototype =
    R"(<prototype><body/><controller config="c"><params/></controller>
<links>
  <link geometry="box"/><link geometry="cylinder"/><link geometry="sphere"/><link geometry="capsule"/>
  <link geometry="hull"><hull><vertex/></hull></link>
  <link geometry="hull"><hull file="f"/></link>
</links>
<joints>
  <joint type="revolute"><parent/><child/></joint>
  <joint type="prismatic"><parent/><child/></joint>
  <joint type="fixed"><parent/><child/></joint>
</joints>
<devices>
  <leds><led id="l"/></leds>
  <directional_leds><directional_led id="d"/></directional_leds>
  <tags><tag id="t"/></tags>
  <radios><radio id="r"/></radios>
  <magnets>
    <magnet id="m"/><magnet shape="box"/><magnet shape="cylinder"/><magnet shape="sphere"/>
  </magnets>
  <proximity_sensors><sensor/><ring/></proximity_sensors>
  <range_and_bearing/>
  <battery/>
</devices></prototype>
)";
constexpr std::string_view rest_of_arena = R"(
<box movable="false"/>
<floor source="image"/>
<distribute>
  <position method="uniform"/><orientation method="gaussian"/><entity/>
</distribute>
<distribute>
  <position method="gaussian"/><orientation method="constant"/><entity/>
</distribute>
<distribute>
  <position method="constant"/><orientation method="grid"/><entity/>
</distribute>
<distribute>
  <position method="grid"/><orientation method="uniform"/><entity/>
</distribute>
)";

std::string empty_elements(std::span<const std::string_view> names) {
  return names.empty() ? "" : fmt::format("<{}/>\n", fmt::join(names, "/>\n<"));
}

/// Every kind of entity with what it may have; anything else is a fault.
std::string entities() {
  std::string text;
  for (const std::string_view name : entity_names()) {
    if (name == "prototype") {
      text += prototype;
      continue;
    }
    text += fmt::format(
        "<{0}><body/><controller config=\"c\"><params/></controller><leds><led "
        "id=\"l\"/></leds><battery/>"
        "<dynamics2d><differential_steering/></dynamics2d></{0}>\n",
        name);
  }
  return text;
}

std::string specimen() {
  return fmt::format(
      "{}<media>{}</media>\n"
      "<controllers><lua_controller id=\"c\"><actuators>{}{}</actuators><sensors>{}{}</sensors>"
      "<params/></lua_controller><external_controller><actuators/><sensors/><params/>"
      "</external_controller></controllers>\n<arena>{}{}</arena></argos-configuration>",
      beginning, empty_elements(media_names()), empty_elements(actuator_names()),
      actuators_with_parts, empty_elements(sensor_names()), sensors_with_parts, entities(),
      rest_of_arena);
}

}  // namespace

Vocabulary whole_vocabulary(const RunAttributes& run) {
  Vocabulary vocabulary;
  ReadOptions options;
  options.run = run;
  options.vocabulary = &vocabulary;
  options.open = [](const std::filesystem::path&, std::size_t) { return "is not opened"; };
  read_text(specimen(), "specimen", options);
  return vocabulary;
}

}  // namespace ziggurat::scene
