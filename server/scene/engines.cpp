// SPDX-License-Identifier: MIT
// <physics_engines>: one three-dimensional world. Its defaults for surfaces and damping are read
// before any body is.

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

constexpr unsigned most_iterations = 1'000'000;  // substeps of a tick
constexpr unsigned many_iterations = 10'000;     // beyond which a scene is doubted
constexpr double strong_gravity = 1000;          // likewise [m/s^2]
constexpr double usual_gravity = 10.0;           // [m/s^2], the dialect's default of `g`
constexpr std::array<std::string_view, 3> engine_names{"dynamics3d", "dynamics2d", "pointmass3d"};
constexpr std::string_view other_engine = "physx";  // one of rigid bodies, too

void read_floor(Draft& draft, Element floor) {
  Floor& out = draft.scene.physics.floor.emplace();
  out.height = floor.optional("height", In{"m", non_negative}, 0.0);
  out.surface = read_surface(draft, floor, Surface{});
  floor.done();
}

void read_gravity(Draft& draft, Element gravity) {
  const double g = gravity.optional("g", In{"m/s²", number}, usual_gravity);
  draft.scene.physics.gravity = g;
  if (std::abs(g) > strong_gravity) {
    draft.report.warn(
        gravity.where("g"), "strong gravity",
        gravity.sentence(
            "g",
            "is stronger than 1000 m/s^2, a hundred times what the Earth's is; write g=\"9.8\""));
  } else if (g < 0) {
    draft.report.warn(
        gravity.where("g"), "gravity",
        gravity.sentence("g",
                         fmt::format("lets everything fall up: g is the acceleration downwards; "
                                     "write g=\"{:.6g}\"",
                                     -g)));
  }
  gravity.done();
}

void read_magnetism(Draft& draft, Element magnetism) {
  Magnetism& out = draft.scene.physics.magnetism.emplace();
  out.force_constant = magnetism.optional("force_constant", non_negative, out.force_constant);
  out.max_distance = magnetism.optional("max_distance", In{"m", positive});
  out.adaptive =
      magnetism.optional("precision", OneOf<bool>{{"dipole", false}, {"adaptive", true}}, false);
  out.tolerance = magnetism.optional("tolerance", positive, out.tolerance);
  if (out.tolerance < 1e-3 || out.tolerance > 0.1) {
    magnetism.fault_at("tolerance", "is out of range; write a number from 0.001 to 0.1");
  }
  out.taper = magnetism.optional("taper", non_negative, 0.0);
  if (out.taper > 0 && (out.taper > 1 || !out.max_distance)) {
    magnetism.fault_at("taper", "is a share of max_distance, from 0 to 1; write both");
  }
  magnetism.done();
}

void read_dynamics3d(Draft& draft, Element& engine) {
  Physics& physics = draft.scene.physics;
  const Clock of_scene =
      engine.optional("clock", OneOf<Clock>{{"nominal", Clock::nominal}, {"beta50", Clock::beta50}},
                      Clock::nominal);
  physics.clock = draft.options.clock.value_or(of_scene);
  const std::string_view solver = written(engine, "solver");
  physics.had_second_core = solver.empty() ? physics.clock == Clock::beta50 : solver == "sweeps";
  physics.max_substep = engine.optional("max_substep", duration);
  draft.defaults.friction = engine.optional("friction", non_negative);
  draft.defaults.rolling_friction = engine.optional("rolling_friction", In{"m", non_negative});
  draft.defaults.spinning_friction = engine.optional("spinning_friction", In{"m", non_negative});
  draft.defaults.restitution = engine.optional("restitution", non_negative);
  draft.defaults.linear_damping = engine.optional("linear_damping", non_negative);
  draft.defaults.angular_damping = engine.optional("angular_damping", non_negative);
  if (auto floor = engine.child("floor")) read_floor(draft, *floor);
  if (auto gravity = engine.child("gravity")) read_gravity(draft, *gravity);
  if (auto magnetism = engine.child("magnetism")) read_magnetism(draft, *magnetism);
  engine.done();
}

/// Reads the force and torque with which the ground of a <dynamics2d> brakes.
void read_ground(Element friction, Plane& plane) {
  plane.box.max_force =
      friction.optional("box_linear_friction", In{"N", non_negative}, plane.box.max_force);
  plane.box.max_torque =
      friction.optional("box_angular_friction", In{"N·m", non_negative}, plane.box.max_torque);
  plane.cylinder.max_force = friction.optional("cylinder_linear_friction", In{"N", non_negative},
                                               plane.cylinder.max_force);
  plane.cylinder.max_torque = friction.optional("cylinder_angular_friction",
                                                In{"N·m", non_negative}, plane.cylinder.max_torque);
  friction.done();
}

void note_one_world(Draft& draft, const Element& engine) {
  draft.report.notice(
      engine.where(),
      fmt::format("<{}> runs in the same 3D world as everything else", engine.name()));
}

void read_dynamics2d(Draft& draft, Element& engine) {
  note_one_world(draft, engine);
  Plane plane;
  plane.elevation = engine.optional("elevation", In{"m", number}, 0.0);
  if (auto friction = engine.child("friction")) read_ground(*friction, plane);
  engine.child_without_effect("spatial_hash", "bodies are found by their place anyway");
  engine.child_without_effect("boundaries", "the world is one and unbounded");
  engine.done();
  draft.scene.physics.planes.push_back(plane);
}

void read_pointmass3d(Draft& draft, Element& engine) {
  note_one_world(draft, engine);
  engine.child_without_effect("boundaries", "the world is one and unbounded");
  engine.done();
}

void read_engine(Draft& draft, Element& engine) {
  if (engine.name() == "dynamics2d") return read_dynamics2d(draft, engine);
  if (engine.name() == "pointmass3d") return read_pointmass3d(draft, engine);
  read_dynamics3d(draft, engine);
}

}  // namespace

Surface read_surface(Draft& draft, Element& element, const Surface& usual) {
  const auto& d = draft.defaults;
  Surface out{
      element.optional("friction", non_negative, d.friction.value_or(usual.friction)),
      element.optional("rolling_friction", In{"m", non_negative},
                       d.rolling_friction.value_or(usual.rolling_friction)),
      element.optional("spinning_friction", In{"m", non_negative},
                       d.spinning_friction.value_or(usual.spinning_friction)),
      element.optional("restitution", non_negative, d.restitution.value_or(usual.restitution))};
  if (out.restitution > 1) element.fault_at("restitution", "is over 1; write a number from 0 to 1");
  return out;
}

Damping read_damping(Draft& draft, Element& element, const Damping& usual) {
  const auto& d = draft.defaults;
  return {
      element.optional("linear_damping", non_negative, d.linear_damping.value_or(usual.linear)),
      element.optional("angular_damping", non_negative, d.angular_damping.value_or(usual.angular)),
      !element.has("linear_damping") && !d.linear_damping,
      !element.has("angular_damping") && !d.angular_damping};
}

void read_engines(Draft& draft, Element& root) {
  auto engines = root.required_child("physics_engines");
  if (!engines) return;
  Physics& physics = draft.scene.physics;
  physics.clock = draft.options.clock.value_or(Clock::nominal);
  physics.had_second_core = physics.clock == Clock::beta50;
  Ids ids;
  bool has_dynamics3d = false;
  for (Element& engine : engines->children()) {
    const bool stands_in = engine.name() == other_engine;
    const bool three = engine.name() == "dynamics3d" || stands_in;
    if (stands_in && !draft.options.lenient) {
      engine.fault("is not supported; use <dynamics3d> (--lenient reads it as one)");
      continue;
    }
    if (stands_in) {
      draft.report.notice(engine.where(),
                          fmt::format("<{}> is read as <dynamics3d>", other_engine));
    } else if (std::ranges::find(engine_names, engine.name()) == engine_names.end()) {
      engine.unknown_in(engines->name(), engine_names);
      continue;
    }
    const std::string id = engine.required("id", identifier);
    const unsigned iterations = engine.optional("iterations", Whole{1, most_iterations}, 10);
    if (iterations > many_iterations) {
      draft.report.warn(
          engine.where("iterations"), "iterations",
          engine.sentence("iterations",
                          "are so many substeps of each tick, which takes long; write 10 to 1000"));
    }
    take_id(engine, ids, id, "engine");
    if (three && has_dynamics3d && !draft.options.lenient) {
      engine.fault(
          "is the second of its kind; there is one world, so write one <dynamics3d> (--lenient "
          "leaves this one out)");
      continue;
    }
    if (three && has_dynamics3d) {
      draft.report.notice(engine.where(),
                          fmt::format("this <{}> is left out: there is one world, and the engine "
                                      "before says how it is simulated",
                                      engine.name()));
      continue;
    }
    if (three || !draft.has_engine) {
      physics.id = id;
      physics.iterations = iterations;
      physics.where = engine.where();
    }
    draft.has_engine = true;
    has_dynamics3d |= three;
    read_engine(draft, engine);
  }
  physics.flat = !physics.planes.empty() && !has_dynamics3d;
  engines->done();
}

}  // namespace ziggurat::scene
