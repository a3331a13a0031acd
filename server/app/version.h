#pragma once

namespace ziggurat::app {

inline constexpr const char* version = ZIGGURAT_VERSION;

}  // namespace ziggurat::app
