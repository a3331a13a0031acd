// SPDX-License-Identifier: MIT
#pragma once
// A model in a file of its own, and scenes that include it, in memory.

#include <filesystem>
#include <map>
#include <string>
#include <variant>

#include "scene_text.h"

namespace ziggurat::scene {

using Files = std::map<std::string, std::string>;

/// Reads from memory only: paths as written are the files' identities.
inline ReadOptions options_with(Files files) {
  ReadOptions options;
  options.open = [files = std::move(files)](
                     const std::filesystem::path& path,
                     std::size_t max_size) -> std::variant<File, std::string> {
    const auto found = files.find(path.string());
    if (found == files.end()) return "does not exist; check its path";
    if (found->second.size() > max_size) return "is larger than it may be";
    return File{path.string(), found->second};
  };
  return options;
}

inline constexpr const char* block =
    "<ziggurat-models>\n"
    "<controllers>\n"
    "<lua_controller id=\"blink\"><actuators><leds implementation=\"default\" medium=\"leds\"/>"
    "</actuators><sensors/><params script=\"blink.lua\"/></lua_controller>\n"
    "</controllers>\n"
    "<models>\n"
    "<prototype id=\"block\">\n"
    "<links ref=\"core\">\n"
    "<link id=\"core\" geometry=\"box\" size=\"1,1,1\" mass=\"2\"/>\n"
    "<link id=\"pole\" geometry=\"sphere\" radius=\"0.1\" mass=\"1\"/>\n"
    "</links>\n"
    "<joints><joint id=\"j\" type=\"spherical\"><parent link=\"core\"/><child link=\"pole\"/>"
    "</joint></joints>\n"
    "<devices>\n"
    "<leds medium=\"leds\"><led anchor=\"pole\" offset=\"1,2,3\" color=\"red\"/></leds>\n"
    "</devices>\n"
    "<controller config=\"blink\"><params script=\"own.lua\"/></controller>\n"
    "</prototype>\n"
    "</models>\n"
    "</ziggurat-models>\n";

inline constexpr const char* include_block = "<include file=\"parts/block.argos\"/>";

inline SceneText using_block(const std::string& elements, const std::string& rest = include_block) {
  SceneText text;
  text.media = "<media><led id=\"leds\"/><tag id=\"tags\"/></media>";
  text.controllers =
      "<controllers><external_controller id=\"other\"><actuators/><sensors/></external_controller>"
      "</controllers>";
  text.arena = "<arena size=\"2,2,2\">\n" + elements + "</arena>";
  text.rest = rest + "\n";
  return text;
}

inline ReadResult read_block(const std::string& elements) {
  return using_block(elements).read(options_with({{"parts/block.argos", block}}));
}

}  // namespace ziggurat::scene
