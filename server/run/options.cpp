#include "run/options.h"

#include <fmt/format.h>

#include "text/numbers.h"

namespace ziggurat::run {

const std::string& only_scene(const Options& options) {
  if (options.scenes.empty())
    throw text::UsageError("which scene? the path of a scene file is due");
  if (options.scenes.size() > 1) {
    throw text::UsageError(
        fmt::format("one scene at a time; '{}' is one too many", options.scenes[1]));
  }
  return options.scenes.front();
}

}  // namespace ziggurat::run
