// SPDX-License-Identifier: MIT
#pragma once
// The reference of the scene format: every element and attribute, as tables in Markdown.

#include <span>
#include <string>

namespace ziggurat::cli {

/// The tables of all elements, or of those with the names.
/// @throws text::UsageError  for a name that no element has, with a suggestion
std::string scene_reference(std::span<const std::string> names);

}  // namespace ziggurat::cli
