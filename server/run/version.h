#pragma once

namespace ziggurat::run {

inline constexpr const char* version = ZIGGURAT_VERSION;

}  // namespace ziggurat::run
