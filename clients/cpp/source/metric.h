#pragma once
// Names and values of metrics.

#include <string_view>

namespace ziggurat {

/// @throws std::invalid_argument that says what is allowed
void check_metric(std::string_view name, double value);

}  // namespace ziggurat
