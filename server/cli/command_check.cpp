// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "processes/commands.h"
#include "processes/scripts.h"
#include "reports/console.h"
#include "run/loading.h"
#include "scene/devices.h"
#include "scene/values.h"
#include "simulation/scene_warnings.h"
#include "simulation/simulation.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

using Severity = scene::Problem::Severity;

// A model of the scene and the number of its entities.
struct ModelUse {
  std::string id;
  std::size_t entities = 0;
};

// The deadline policy that the scene sets for a controller.
struct ControllerDeadline {
  std::string id;
  scene::DeadlinePolicy policy;
};

struct Finding {
  std::vector<scene::Problem> problems;
  std::vector<ModelUse> models;
  std::vector<ControllerDeadline> deadlines;
  std::size_t entities = 0;  ///< in the world; 0 if it could not be built
  std::size_t robots = 0;

  std::size_t count(Severity severity) const {
    return static_cast<std::size_t>(
        std::ranges::count(problems, severity, &scene::Problem::severity));
  }
};

// Notices on tags that pictures cannot show; one per tag of a model.
void add_plain_tags(const scene::Scene& scene, std::vector<scene::Problem>& problems) {
  std::set<scene::Location> seen;
  const auto add = [&](const scene::Entity& entity) {
    for (const auto& tag : entity.devices.tags) {
      if (scene::tag_pattern(tag.payload) || !seen.insert(tag.where).second) continue;
      const auto owner = entity.model ? fmt::format("model '{}'", scene.models[*entity.model].id)
                                      : fmt::format("'{}'", entity.id);
      problems.push_back({Severity::notice, scene.files[tag.where.file], tag.where,
                          fmt::format("tag '{}' of {} is a plain white square in pictures; a "
                                      "payload that is an integer 0 to 586 is drawn as that "
                                      "pattern of AprilTag 36h11",
                                      tag.id, owner)});
    }
  };
  for (const auto& entity : scene.entities) add(entity);
  for (const auto& distribution : scene.distributions) add(distribution.entity);
}

// The joint that an actuator moves, in the first entity with its controller; none if there is none.
const scene::Joint* joint_of(const scene::Scene& scene, std::size_t controller,
                             const std::string& id) {
  const auto find = [&](const scene::Entity& entity) -> const scene::Joint* {
    if (entity.controller != controller) return nullptr;
    const auto found = std::ranges::find(entity.joints, id, &scene::Joint::id);
    return found == entity.joints.end() ? nullptr : &*found;
  };
  for (const auto& entity : scene.entities) {
    if (const auto* joint = find(entity)) return joint;
  }
  for (const auto& distribution : scene.distributions) {
    if (const auto* joint = find(distribution.entity)) return joint;
  }
  return nullptr;
}

// Notices on motors with an impulse per substep, where the scene has not the default number of
// substeps.
void add_impulses(const scene::Scene& scene, std::vector<scene::Problem>& problems) {
  const unsigned iterations = scene.physics.iterations, usual = scene::Physics{}.iterations;
  if (iterations == usual) return;
  const auto substeps_per_second = [&](double count) {
    const double nominal = count * scene.experiment.ticks_per_second;
    return scene.physics.clock == scene::Clock::beta50 ? nominal * count : nominal;
  };
  for (std::size_t c = 0; c < scene.controllers.size(); ++c) {
    for (const auto& motor : scene.controllers[c].devices.joints.actuators) {
      const auto* joint = joint_of(scene, c, motor.joint);
      if (joint == nullptr || motor.max_impulse == 0) continue;
      const bool turns = joint->type == scene::JointType::revolute;
      problems.push_back(
          {Severity::notice, scene.files[motor.where.file], motor.where,
           fmt::format("max_impulse is per substep: joint {} has {:.6g} {} with iterations=\"{}\", "
                       "and {:.6g} with {}; write {} instead, which stays when iterations change",
                       scene::in_quotes(motor.joint),
                       motor.max_impulse * substeps_per_second(iterations), turns ? "N m" : "N",
                       iterations, motor.max_impulse * substeps_per_second(usual), usual,
                       turns ? "max_torque" : "max_force")});
    }
  }
}

std::vector<ModelUse> uses_of_models(const scene::Scene& scene) {
  std::vector<ModelUse> uses;
  for (const auto& model : scene.models) uses.push_back({model.id});
  for (const auto& entity : scene.entities) {
    if (entity.model) ++uses[*entity.model].entities;
  }
  for (const auto& group : scene.distributions) {
    if (group.entity.model) uses[*group.entity.model].entities += group.quantity;
  }
  return uses;
}

std::vector<ControllerDeadline> deadlines_of(const scene::Scene& scene) {
  std::vector<ControllerDeadline> deadlines;
  for (const auto& controller : scene.controllers) {
    if (controller.deadline) deadlines.push_back({controller.id, *controller.deadline});
  }
  return deadlines;
}

// Reads the file, compiles the scripts and, if there is no fault so far, builds the world.
Finding examine(const std::string& path, const run::Options& options) {
  auto read = scene::read_file(path, options.scene_file);
  Finding finding{std::move(read.problems), uses_of_models(read.scene), deadlines_of(read.scene)};
  const auto add = [&](const std::vector<scene::Problem>& more) {
    finding.problems.insert(finding.problems.end(), more.begin(), more.end());
  };
  add(processes::check_scripts(read.scene, path));
  add(processes::find_commands(read.scene, path));
  if (finding.count(Severity::fault) > 0) return finding;
  add_plain_tags(read.scene, finding.problems);
  add_impulses(read.scene, finding.problems);
  try {
    const simulation::Simulation simulation(
        read.scene, {run::choose_seed(options, read.scene.experiment.random_seed)});
    finding.entities = simulation.layout().entities.size();
    finding.robots = simulation.layout().robots.size();
    add(simulation::scene_warnings(read.scene, simulation));
    for (const auto& notice : simulation.notices()) {
      add({{Severity::notice, path, read.scene.physics.where, notice}});
    }
  } catch (const scene::SceneError& error) {
    add(error.problems());
  }
  return finding;
}

nlohmann::ordered_json to_json(const std::string& path, const Finding& finding) {
  auto problems = nlohmann::ordered_json::array();
  for (const auto& problem : finding.problems) {
    problems.push_back({{"severity", scene::to_text(problem.severity)},
                        {"file", problem.file},
                        {"line", problem.where.line},
                        {"column", problem.where.column},
                        {"text", scene::text_of(problem)}});
  }
  auto models = nlohmann::ordered_json::array();
  for (const auto& model : finding.models) {
    models.push_back({{"id", model.id}, {"entities", model.entities}});
  }
  auto deadlines = nlohmann::ordered_json::array();
  for (const auto& [id, policy] : finding.deadlines) {
    deadlines.push_back({{"controller", id}, {"policy", scene::to_text(policy)}});
  }
  return {{"scene", path},
          {"ok", finding.count(Severity::fault) == 0},
          {"entities", finding.entities},
          {"robots", finding.robots},
          {"models", models},
          {"deadlines", deadlines},
          {"problems", problems}};
}

std::string verdict(const std::string& path, const Finding& finding) {
  const auto faults = finding.count(Severity::fault), notices = finding.count(Severity::notice),
             warnings = finding.count(Severity::warning);
  const auto counted = [](std::size_t n, const char* what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  const std::string warned = warnings == 0 ? "" : ", " + counted(warnings, "warning");
  if (faults > 0) {
    return fmt::format("{}: {}{}, {}", path, counted(faults, "fault"), warned,
                       counted(notices, "notice"));
  }
  std::string models;
  for (const auto& model : finding.models) {
    models += fmt::format("{}{} of model {}", models.empty() ? " (" : ", ", model.entities,
                          scene::in_quotes(model.id));
  }
  if (!models.empty()) models += ")";
  std::string deadlines;
  for (const auto& [id, policy] : finding.deadlines) {
    deadlines += fmt::format("{}{}={}", deadlines.empty() ? " (deadlines: " : ", ", id,
                             scene::to_text(policy));
  }
  if (!deadlines.empty()) deadlines += ")";
  return fmt::format(
      "{}: good; {}{}, {} with a controller{}{}; {}", path,
      finding.entities == 1 ? "1 entity" : fmt::format("{} entities", finding.entities), models,
      finding.robots, deadlines, warned, counted(notices, "notice"));
}

}  // namespace

std::string help_check() {
  return R"(usage: ziggurat check SCENE... [OPTION]...

Reports every fault of scene files, and everything in them that has no effect here or is probably not
what was meant: reads them completely, compiles their Lua scripts and places their entities, but starts no
controller.

  ziggurat check vehicle.argos
  ziggurat check scenes/*.argos --quiet
      faults only
  ziggurat check vehicle.argos --json
      an array with an object per scene

  ziggurat check vehicle.argos --strict
      warnings count as faults

Exit codes: 0 no scene has a fault; 1 at least one has, or with --strict a warning.
)";
}

int execute_check(const Arguments& arguments) {
  const auto options = parse_options(arguments, run::by_check);
  check_apart(Values(parse(arguments, options_of(run::by_check)).values), "json", {"quiet"});
  if (options.scenes.empty())
    throw text::UsageError("no scene is given; write: ziggurat check SCENE...");
  reports::Console console({options.quiet, false});
  auto report = nlohmann::ordered_json::array();
  bool good = true;
  for (const auto& path : options.scenes) {
    const auto finding = examine(path, options);
    good = good && finding.count(Severity::fault) == 0 &&
           !(options.strict && finding.count(Severity::warning) > 0);
    if (options.json) {
      report.push_back(to_json(path, finding));
      continue;
    }
    for (const auto& problem : finding.problems) console.problem(problem);
    if (!options.quiet) console.result(verdict(path, finding));
  }
  if (options.json) {
    console.result(report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }
  console.flush();
  return good ? reports::exit_code::finished : reports::exit_code::fault;
}

}  // namespace ziggurat::cli
