// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <optional>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/installed_scenes.h"
#include "magnetism/closed_forms.h"
#include "magnetism/field.h"
#include "outputs/output_file.h"
#include "outputs/output_name.h"
#include "physics/magnet_source.h"
#include "reports/console.h"
#include "reports/plot.h"
#include "run/files.h"
#include "scene/reader.h"
#include "text/numbers.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;
using magnetism::Wrench;
using math::Vector3;

constexpr int points = 120;

po::options_description plot_options() {
  po::options_description options("Options");
  auto add = options.add_options();
  add("magnets", po::value<std::string>()->value_name("A,B"),
      "the two magnets, each ENTITY or ENTITY/MAGNET; the first two of the scene without it");
  add("axis", po::value<std::string>()->value_name("x|y|z"),
      "direction from A to B in A's anchor frame (default: along A's moment)");
  add("turn", po::value<std::string>()->value_name("DEGREES"),
      "turns B about an axis across that direction, which gives a torque (default 0)");
  add("from", po::value<std::string>()->value_name("M"),
      "smallest distance of the centres [m] (default: just apart, or 5 mm for points)");
  add("to", po::value<std::string>()->value_name("M"),
      "largest distance [m] (default: 20 times the smallest)");
  add("out", po::value<std::string>()->value_name("FILE.svg"),
      "the picture (default magnetism.svg; - is stdout)");
  return options;
}

/// Two magnets of a scene, each with its strength in the anchor frame.
struct Chosen {
  std::string name;
  magnetism::Magnet magnet;
};

Chosen choose(const scene::Entity& entity, const scene::Magnet& magnet,
              const scene::Magnetism& settings) {
  Chosen chosen{entity.id + "/" + magnet.id, {}};
  chosen.magnet.shape = physics::shape_of(magnet);
  if (magnet.shape) chosen.magnet.orientation = magnet.shape->orientation;
  chosen.magnet.passive_moment = physics::passive_moment(magnet, settings);
  return chosen;
}

/// The placed ones, and the patterns of the distributed ones.
std::vector<const scene::Entity*> all_entities(const scene::Scene& scene) {
  std::vector<const scene::Entity*> entities;
  for (const auto& entity : scene.entities) entities.push_back(&entity);
  for (const auto& group : scene.distributions) entities.push_back(&group.entity);
  return entities;
}

Chosen find_magnet(const scene::Scene& scene, const scene::Magnetism& settings,
                   const std::string& name) {
  const auto slash = name.find('/');
  for (const scene::Entity* entity : all_entities(scene)) {
    if (entity->id != name.substr(0, slash)) continue;
    for (const auto& magnet : entity->devices.magnets) {
      if (slash == std::string::npos || magnet.id == name.substr(slash + 1))
        return choose(*entity, magnet, settings);
    }
  }
  throw text::UsageError(
      fmt::format("--magnets: the scene has no magnet '{}'; write ENTITY or ENTITY/MAGNET", name));
}

std::vector<Chosen> choose_pair(const scene::Scene& scene, const scene::Magnetism& settings,
                                const po::variables_map& values) {
  if (values.count("magnets")) {
    const auto names = values["magnets"].as<std::string>();
    const auto comma = names.find(',');
    if (comma == std::string::npos)
      throw text::UsageError(
          "--magnets must be two names with a comma between them, as left,right/magnet_2");
    return {find_magnet(scene, settings, names.substr(0, comma)),
            find_magnet(scene, settings, names.substr(comma + 1))};
  }
  std::vector<Chosen> pair;
  for (const scene::Entity* entity : all_entities(scene)) {
    for (const auto& magnet : entity->devices.magnets) {
      if (pair.size() < 2) pair.push_back(choose(*entity, magnet, settings));
    }
  }
  if (pair.empty()) throw text::UsageError("the scene has no magnets; at least one is needed");
  if (pair.size() == 1) pair.push_back(pair[0]);  // against another one of the same kind
  return pair;
}

/// Force and torque of A on B at a pose in the frame of A.
Wrench act(std::vector<magnetism::Magnet> pair, const math::Pose& second,
           magnetism::Precision precision, double tolerance) {
  pair[0].body = 0;
  pair[1].body = 1;
  magnetism::Options options;
  options.precision = precision;
  options.tolerance = tolerance;
  magnetism::Field field(std::move(pair), 2, options);
  const math::Pose poses[] = {{}, second};
  const double currents[] = {0, 0};
  Wrench wrenches[2];
  field.evaluate(0, poses, currents, wrenches);
  return wrenches[1];
}

/// The force on B [N] by a formula of the literature, if there is one for this pair and pose.
std::optional<double> closed_form(const magnetism::Magnet& a, const magnetism::Magnet& b,
                                  const Vector3& offset, bool turned) {
  const auto ball = [](const magnetism::Shape& shape) {
    return std::holds_alternative<magnetism::Sphere>(shape) ||
           std::holds_alternative<magnetism::PointShape>(shape);
  };
  if (turned) return std::nullopt;
  if (ball(a.shape) && ball(b.shape)) {
    return magnetism::dipole_pair(b.passive_moment, a.passive_moment, offset).force_on_first.norm();
  }
  const auto axial = [](const magnetism::Magnet& m) {
    const Vector3 local = m.orientation.conjugate() * m.passive_moment;
    return m.orientation.isApprox(math::Quaternion::Identity()) &&
           local.head<2>().norm() < 1e-9 * local.norm();
  };
  if (!axial(a) || !axial(b)) return std::nullopt;
  const auto remanence = [](const magnetism::Magnet& m) {
    return m.passive_moment.z() * magnetism::vacuum_permeability / magnetism::volume(m.shape);
  };
  const auto *box_a = std::get_if<magnetism::Box>(&a.shape),
             *box_b = std::get_if<magnetism::Box>(&b.shape);
  if (box_a && box_b) {
    return magnetism::parallel_box_force(box_a->size, box_b->size, offset, remanence(a),
                                         remanence(b))
        .norm();
  }
  const auto *rod_a = std::get_if<magnetism::Cylinder>(&a.shape),
             *rod_b = std::get_if<magnetism::Cylinder>(&b.shape);
  const double gap =
      rod_a && rod_b ? std::abs(offset.z()) - (rod_a->height + rod_b->height) / 2 : 0;
  if (rod_a && rod_b && rod_a->radius == rod_b->radius && offset.head<2>().norm() < 1e-9 &&
      gap > 0) {
    return std::abs(magnetism::coaxial_cylinder_force(rod_a->radius, rod_a->height, rod_b->height,
                                                      gap, remanence(a), remanence(b)));
  }
  return std::nullopt;
}

double option_number(const po::variables_map& values, const char* name, double fallback) {
  return values.count(name)
             ? text::to_number(std::string("--") + name, values[name].as<std::string>())
             : fallback;
}

Vector3 direction_of(const po::variables_map& values, const Vector3& moment) {
  if (!values.count("axis"))
    return moment.norm() > 0 ? Vector3(moment.normalized()) : Vector3(0, 0, 1);
  const auto axis = values["axis"].as<std::string>();
  if (axis == "x") return Vector3::UnitX();
  if (axis == "y") return Vector3::UnitY();
  if (axis == "z") return Vector3::UnitZ();
  throw text::UsageError("--axis is '" + axis + "'; write x, y or z");
}

/// The torque [N m], or 0 if it is a rounding error.
double torque_beyond_rounding(const Wrench& wrench, double distance) {
  const double torque = wrench.torque.norm();
  return torque > 1e-12 * wrench.force.norm() * distance ? torque : 0;
}

std::vector<reports::Panel> plot(const std::vector<Chosen>& pair, const scene::Magnetism& settings,
                                 const po::variables_map& values) {
  const std::vector<magnetism::Magnet> magnets{pair[0].magnet, pair[1].magnet};
  const Vector3 direction = direction_of(values, magnets[0].passive_moment);
  const double turn = option_number(values, "turn", 0) * EIGEN_PI / 180;
  const math::Quaternion turned(Eigen::AngleAxisd(turn, direction.unitOrthogonal()));
  const double touching =
      magnetism::bounding_radius(magnets[0].shape) + magnetism::bounding_radius(magnets[1].shape);
  const double from = option_number(values, "from", touching > 0 ? 1.02 * touching : 0.005);
  const double to = option_number(values, "to", 20 * from);
  if (!(from > 0) || !(to > from))
    throw text::UsageError("--from must be more than 0, and --to more than --from");
  reports::Panel force{"Force on B",
                       "distance of the centres [m]",
                       "|F| [N]",
                       {},
                       {{"one dipole each", "#888", false, {}},
                        {"adaptive", "#06c", false, {}},
                        {"closed form", "#c30", true, {}}}};
  reports::Panel torque{"Torque on B about its centre",
                        "distance of the centres [m]",
                        "|T| [N m]",
                        {},
                        {{"one dipole each", "#888", false, {}}, {"adaptive", "#06c", false, {}}}};
  for (int i = 0; i < points; ++i) {
    const double distance = from * std::pow(to / from, i / (points - 1.0));
    const math::Pose second{direction * distance, turned};
    const Wrench dipole = act(magnets, second, magnetism::Precision::dipole, settings.tolerance);
    const Wrench adaptive =
        act(magnets, second, magnetism::Precision::adaptive, settings.tolerance);
    force.x.push_back(distance);
    torque.x.push_back(distance);
    force.curves[0].y.push_back(dipole.force.norm());
    force.curves[1].y.push_back(adaptive.force.norm());
    force.curves[2].y.push_back(
        closed_form(magnets[0], magnets[1], second.position, turn != 0).value_or(0));
    torque.curves[0].y.push_back(torque_beyond_rounding(dipole, distance));
    torque.curves[1].y.push_back(torque_beyond_rounding(adaptive, distance));
  }
  return {force, torque};
}

}  // namespace

std::string help_magnetism() {
  return fmt::format(R"(usage: ziggurat magnetism plot SCENE [OPTION]...

Plots force and torque between two magnets of a scene over their distance: each as one dipole, with
adaptive precision at the scene's tolerance, and by a closed form of the literature where there is
one (spheres and points; parallel boxes and coaxial cylinders of one radius, magnetised along z).
Both magnets are oriented as in their anchor frames, without current.

  ziggurat magnetism plot scenes/dynamics3d_magnetism_test.argos --out rows.svg
  ziggurat magnetism plot scene.argos --magnets left,right/magnet_2 --axis z --turn 30

{})",
                     fmt::streamed(plot_options()));
}

int execute_magnetism(const Arguments& arguments) {
  const auto parsed = parse(arguments, plot_options());
  if (parsed.positional.size() != 2 || parsed.positional[0] != "plot") {
    throw text::UsageError(
        "the arguments are not understood; write: ziggurat magnetism plot SCENE");
  }
  reports::Console console;
  const std::string scene = scene_path(parsed.positional[1]);
  const auto read = scene::read_file(scene);
  if (!read.ok()) throw scene::SceneError(read.problems);
  const std::string path =
      parsed.values.count("out") ? parsed.values["out"].as<std::string>() : "magnetism.svg";
  outputs::check_output({"--out", path, {".svg"}},
                        run::taken_by_scene(run::files_of(read.scene, scene)));
  const auto settings = read.scene.physics.magnetism.value_or(scene::Magnetism{});
  const auto pair = choose_pair(read.scene, settings, parsed.values);
  const auto panels = plot(pair, settings, parsed.values);
  outputs::OutputFile file(path);
  file.buffer().append(to_svg(fmt::format("A = {}, B = {}", pair[0].name, pair[1].name), panels));
  file.close();
  const std::string line = fmt::format("{}: {} and {}", path, pair[0].name, pair[1].name);
  path == "-" ? console.report(line) : console.result(line);
  console.flush();
  return reports::exit_code::finished;
}

}  // namespace ziggurat::cli
