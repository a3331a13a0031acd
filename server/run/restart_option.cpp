#include "run/restart_option.h"

#include <fmt/format.h>

#include <cstdint>

#include "run/controller_option.h"
#include "text/numbers.h"

namespace ziggurat::run {
namespace {

constexpr std::uint64_t most_times = 1'000'000;

}  // namespace

RestartOption to_restart(const std::string& value) {
  RestartOption option;
  const auto equals = value.rfind('=');  // ids may contain one
  const bool has_name = equals != std::string::npos;
  if (has_name) option.controller = value.substr(0, equals);
  const std::uint64_t times =
      text::to_integer("--restart", has_name ? value.substr(equals + 1) : value);
  if ((has_name && option.controller.empty()) || times > most_times) {
    throw text::UsageError(fmt::format(
        "--restart is '{}'; write CONTROLLER=N or, for all controllers, N: 0 to {}, how often a "
        "process is started again",
        value, most_times));
  }
  option.times = static_cast<unsigned>(times);
  return option;
}

std::vector<unsigned> restarts_of(const std::vector<RestartOption>& options,
                                  const scene::Scene& scene) {
  std::vector<unsigned> restarts(scene.controllers.size());
  apply_by_controller("--restart", options, scene,
                      [&](const RestartOption& option, std::size_t controller) {
                        restarts[controller] = option.times;
                      });
  return restarts;
}

}  // namespace ziggurat::run
