#include "run/client_scopes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace ziggurat::run {
namespace {

/// Patterns that match none of the names.
std::vector<std::string> without_effect(const std::vector<std::string>& patterns,
                                        const std::vector<std::string>& names) {
  std::vector<std::string> found;
  for (const std::string& pattern : patterns) {
    const network::Glob glob(pattern);
    const auto means = [&](const std::string& name) {
      return name == pattern || glob.matches(name);
    };
    if (std::ranges::none_of(names, means)) found.push_back(pattern);
  }
  return found;
}

}  // namespace

std::vector<std::string> doubts_of(const std::vector<network::ClientKey>& clients,
                                   const scene::Scene& scene, const world::Layout& layout) {
  std::vector<std::string> robots, controllers, doubts;
  for (const auto& robot : layout.robots) robots.push_back(robot.id);
  for (const auto& controller : scene.controllers) controllers.push_back(controller.id);
  for (const network::ClientKey& client : clients) {
    const auto doubt = [&](const char* limit, const char* what,
                           const std::vector<std::string>& patterns) {
      if (patterns.empty()) return;
      doubts.push_back(fmt::format("--curve-clients: {}={} of the key {} means no {} of the scene",
                                   limit, fmt::join(patterns, ","),
                                   client.name.empty() ? client.public_key : client.name, what));
    };
    doubt("robots", "robot", without_effect(client.scope.robots, robots));
    doubt("controllers", "controller", without_effect(client.scope.controllers, controllers));
  }
  return doubts;
}

}  // namespace ziggurat::run
