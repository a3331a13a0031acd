#include "run/options.h"

#include <fmt/format.h>

#include "text/numbers.h"

namespace ziggurat::run {

const std::string& only_scene(const Options& options) {
  if (options.scenes.empty())
    throw text::UsageError("no scene is given; write the path of a scene file");
  if (options.scenes.size() > 1) {
    throw text::UsageError(
        fmt::format("only one scene is allowed; remove '{}'", options.scenes[1]));
  }
  return options.scenes.front();
}

}  // namespace ziggurat::run
