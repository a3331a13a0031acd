// SPDX-License-Identifier: MIT
#include "reports/json_text.h"

#include <nlohmann/json.hpp>

namespace ziggurat::reports {

std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace ziggurat::reports
