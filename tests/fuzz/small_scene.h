// SPDX-License-Identifier: MIT
#pragma once
// A small scene with most kinds of elements, and the check of every entity that was read.

#include <filesystem>
#include <string>
#include <variant>

#include "require.h"
#include "scene/reader.h"

namespace ziggurat::scene {

using fuzz::require;

inline void check_entity(const Entity& entity, const Scene& scene) {
  require(!entity.links.empty());
  require(entity.reference_link < entity.links.size());
  for (const Link& link : entity.links) {
    require(link.offset.position.allFinite() && link.offset.orientation.coeffs().allFinite());
  }
  for (const Joint& joint : entity.joints) {
    require(joint.parent < entity.links.size() && joint.child < entity.links.size());
    require(joint.axis.allFinite());
    require(!joint.limit || joint.limit->lower <= joint.limit->upper);
  }
  require(!entity.controller || *entity.controller < scene.controllers.size());
  require(!entity.model || *entity.model < scene.models.size());
}

inline constexpr const char* models =
    "<m><include file=\"models\"/><controllers><c id=\"c2\"><actuators/><sensors>"
    "<range_and_bearing implementation=\"medium\" medium=\"rab\"/></sensors></c></controllers>"
    "<models><prototype id=\"m\"><links ref=\"a\"><link id=\"a\" geometry=\"sphere\" radius=\"1\" "
    "mass=\"1\"/></links><devices><leds medium=\"leds\"><led anchor=\"a\" offset=\"0,0,0\" "
    "color=\"red\"/></leds></devices><controller config=\"c\"/></prototype></models></m>";

/// The scene's text before and after the content of the arena.
inline constexpr const char* before =
    "<argos-configuration><framework><experiment ticks_per_second=\"10\"/></framework><controllers>"
    "<lua_controller id=\"c\"><actuators><joints implementation=\"default\"><joint id=\"j\" "
    "mode=\"velocity\" max_impulse=\"1\"/></joints></actuators><sensors><cameras "
    "implementation=\"default\"><camera id=\"k\" anchor=\"a\" range=\"0.1:2\" position=\"0,0,0\" "
    "orientation=\"0,0,0\" resolution=\"64,48\" focal_length=\"80,80\" principle_point=\"32,24\">"
    "<tag_detector medium=\"tags\"/></camera></cameras></sensors><params script=\"a.lua\"/>"
    "</lua_controller></controllers><physics_engines><dynamics3d "
    "id=\"d\"/></physics_engines><media>"
    "<led id=\"leds\"/><directional_led id=\"dirleds\"/><tag id=\"tags\"/><radio id=\"radio\"/>"
    "<range_and_bearing id=\"rab\"/></media><arena size=\"9,9,9\">";
inline constexpr const char* after = "</arena></argos-configuration>";

/// Opens included files from memory, never from disk: names that start with `models` are the file
/// of models, names that start with `s` the scene itself under another path.
inline std::variant<File, std::string> open_from_memory(const std::filesystem::path& path,
                                                        const std::string& scene) {
  const std::string name = path.filename().string();
  if (name.starts_with("models")) return File{name, models};
  if (name.starts_with("s")) return File{path.string(), scene};
  return "does not exist";
}

}  // namespace ziggurat::scene
