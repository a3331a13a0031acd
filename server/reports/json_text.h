// SPDX-License-Identifier: MIT
#pragma once
// JSON on one line, for programs.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace ziggurat::reports {

/// Bytes that are not UTF-8, as names of files may have, become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace ziggurat::reports
