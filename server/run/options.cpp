// SPDX-License-Identifier: MIT
#include "run/options.h"

#include <fmt/format.h>

#include "text/numbers.h"

namespace ziggurat::run {

bool wants_report_card(const Options& options) {
  return options.hil || !options.injections.empty() || !options.gate.empty() ||
         !options.report_card.empty() || options.warm_up > 0;
}

const std::string& only_scene(const Options& options) {
  if (options.scenes.empty() || options.scenes.front().empty())
    throw text::UsageError(
        "no scene is given; write the path of a scene file or a name that 'ziggurat scenes' lists, "
        "as in: "
        "ziggurat run vehicle");
  if (options.scenes.size() > 1) {
    throw text::UsageError(fmt::format(
        "only one scene is allowed, which is '{}'; remove '{}', or write the option that "
        "it is the value of",
        options.scenes[0], options.scenes[1]));
  }
  return options.scenes.front();
}

}  // namespace ziggurat::run
