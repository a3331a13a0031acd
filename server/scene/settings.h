// SPDX-License-Identifier: MIT
#pragma once
// Attributes that the command line sets, `--set 'PATH=VALUE'`, and how these options are read.

#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/values.h"

namespace ziggurat::scene {

/// `PATH=VALUE`: split at the first `=` outside of brackets and quotes.
Value<Setting> to_setting(std::string_view text);
/// `NAME=VALUE`.
Value<std::pair<std::string, std::string>> to_parameter(std::string_view text);

/// `--set 'PATH=VALUE'`, as people write it.
std::string to_string(const Setting& setting);

struct Attribute {
  pugi::xml_node element;
  pugi::xml_attribute attribute;
};

/// The attributes of a document that a path names. Those that the path ends with, and that an
/// element does not have, are added to it, empty.
/// @param root  where the path begins
/// @returns them; why not, if the path can't be evaluated or names something else
Value<std::vector<Attribute>> attributes_at(const pugi::xml_node& root, const std::string& path);

/// Why a path names nothing: its first step that is not there, and what is there instead. Continues
/// a sentence that begins with the path.
std::string why_nothing(const pugi::xml_node& root, const std::string& path);

}  // namespace ziggurat::scene
