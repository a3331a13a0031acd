// SPDX-License-Identifier: MIT
// Our errors and those of MuJoCo against closed forms, and what a substep costs in each.
//
// usage: bench_yardstick          errors, a table per check
//        bench_yardstick cost     microseconds of CPU time per substep
//        bench_yardstick robots COUNT (ours | mujoco)     one of them, per robot
//
// MuJoCo runs with elliptic cones, its Newton solver and the contact parameters that it takes by
// default; "stiff": with the shortest time constant that it takes, two steps.

#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "mujoco_models.h"
#include "unit/physics/newton_scene.h"
#include "unit/physics/stepping/touching.h"

namespace {

using namespace ziggurat;
using dynamics::testing::Touching;
using math::Pose;
using math::Vector3;
using physics::World;
namespace scenes = physics::testing;
using yardstick::Model;
using yardstick::text;

constexpr double earth = 9.8;                             // [m/s^2]
constexpr int rates[] = {50, 100, 200, 500, 1000, 2000};  // substeps per second

double cpu_seconds() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// ---- A box slides down a slope: distance over a t^2 / 2, less 1.

constexpr double slope = 0.35, slope_friction = 0.3, slide_time = 3;
const double slide =
    earth * (std::sin(slope) - slope_friction * std::cos(slope)) * slide_time * slide_time / 2;

double our_slide(double h) {
  const math::Quaternion tilt = scenes::about({0, 1, 0}, slope);
  const Vector3 up = tilt * Vector3::UnitZ(), downhill = tilt * Vector3::UnitX();
  World world(scenes::newton(), h);
  world.add(scenes::standing({-0.5 * up, tilt}, scene::Box{{24, 2, 0.5}}, 1));
  const Vector3 start = -4 * downhill;
  world.add(scenes::loose({start, tilt}, scenes::cube, 0.1, slope_friction));
  scenes::run(world, slide_time, h);
  return (scenes::origin(world, 1).position - start).dot(downhill) / slide - 1;
}

double their_slide(double h, bool stiff) {
  Model model(text("<geom type='plane' size='50 50 1' friction='{1} 0 0'/>"
                   "<body pos='0 0 0.05'><freejoint/>"
                   "<geom type='box' size='0.05 0.05 0.05' mass='0.1' friction='{1} 0 0'/></body>",
                   {slope_friction}),
              h, Vector3(earth * std::sin(slope), 0, -earth * std::cos(slope)));
  if (stiff) model.stiffen();
  model.run(slide_time);
  return model.data->qpos[0] / slide - 1;
}

// ---- A slider of 3 m/s on a level floor: the highest gap under it.

constexpr double slider_speed = 3, slider_side = 0.1;

double our_gap(double h) {
  Touching world;
  world.gravity = Vector3(0, 0, -earth);
  world.planes.push_back({Vector3::Zero(), Vector3::UnitZ()});
  world.add_box(Vector3::Constant(slider_side), 1,
                {Vector3(0, 0, slider_side / 2), math::Quaternion::Identity()}, slope_friction);
  world.tree(0).v[3] = slider_speed;
  velocity_kinematics(world.tree(0));
  double highest = 0;
  for (int i = 0; i < 0.8 / h; ++i) {
    world.step(h);
    highest = std::max(highest, world.tree(0).position[0].z() - slider_side / 2);
  }
  return highest;
}

double their_gap(double h, bool stiff) {
  Model model(text("<geom type='plane' size='50 50 1' friction='{1} 0 0'/>"
                   "<body pos='0 0 0.05'><freejoint/>"
                   "<geom type='box' size='0.05 0.05 0.05' mass='1' friction='{1} 0 0'/></body>",
                   {slope_friction}),
              h, Vector3(0, 0, -earth));
  if (stiff) model.stiffen();
  model.run(0.5);  // it sinks into its soft contact first
  const double start = model.data->qpos[2];
  model.data->qvel[0] = slider_speed;
  double highest = 0;
  for (int i = 0; i < 0.8 / h; ++i) {
    model.step();
    highest = std::max(highest, model.data->qpos[2] - start);
  }
  return highest;
}

// ---- An asymmetric body tumbles for 10 s: relative change of its energy.

const Vector3 tumbler_sides(0.3, 0.2, 0.1), tumbler_spin(0.05, 4, 0.05);

double our_tumbling(double h) {
  dynamics::System system;
  system.trees.push_back(dynamics::testing::box(tumbler_sides, 1, {}));
  dynamics::Tree& tree = system.trees[0];
  for (int k = 0; k < 3; ++k) tree.v[k] = tumbler_spin[k];
  velocity_kinematics(tree);
  const double start = dynamics::kinetic_energy(tree);
  for (int i = 0; i < 10 / h; ++i) system.step(h, {});
  return dynamics::kinetic_energy(tree) / start - 1;
}

double their_tumbling(double h, const char* integrator) {
  Model model("<body><freejoint/><geom type='box' size='0.15 0.1 0.05' mass='1'/></body>", h,
              Vector3::Zero(), integrator);
  for (int k = 0; k < 3; ++k) model.data->qvel[3 + k] = tumbler_spin[k];
  const double start = model.energy();
  model.run(10);
  return model.energy() / start - 1;
}

// ---- Pendulums of links of 0.2 m, let go stretched out: energy over what falls to the lowest
// place.

constexpr double link_length = 0.2, link_mass = 0.3;

double our_chain(double h, int links, double seconds) {
  dynamics::System system;
  system.trees.push_back(dynamics::testing::chain(links, link_length, link_mass));
  dynamics::Tree& tree = system.trees[0];
  tree.gravity = Vector3(0, 0, -dynamics::testing::g);
  const double start = dynamics::testing::energy(tree),
               fall = dynamics::testing::g * link_mass * links * link_length * links / 2;
  double worst = 0;
  for (int i = 0; i < seconds / h; ++i) {
    system.step(h, {});
    worst = std::max(worst, std::abs(dynamics::testing::energy(tree) - start) / fall);
  }
  return worst;
}

double their_chain(double h, int links, double seconds, const char* integrator) {
  std::string bodies, ends;
  for (int i = 0; i < links; ++i) {
    bodies += "<body pos='" + std::string(i ? "0.2" : "0") +
              " 0 0'><joint type='hinge' axis='0 1 0'/>"
              "<geom type='box' pos='0.1 0 0' size='0.1 0.01 0.01' mass='0.3'/>";
    ends += "</body>";
  }
  Model model(bodies + ends, h, Vector3(0, 0, -earth), integrator);
  model.without_contacts();
  const double start = model.energy(), fall = earth * link_mass * links * link_length * links / 2;
  double worst = 0;
  for (int i = 0; i < seconds / h; ++i) {
    model.step();
    worst = std::max(worst, std::abs(model.energy() - start) / fall);
  }
  return worst;
}

// ---- Stacks of boxes for 10 s: how far the topmost one moves from where it was placed.

struct Stack {
  int count;
  double side, mass, top_mass;  // [m], [kg]
};
constexpr Stack tower{10, 0.01, 0.01, 0.01}, heavy{2, 0.1, 1, 1000};

double our_stack(double h, const Stack& stack) {
  World world(scenes::newton(true), h);
  const scene::Box box{Vector3::Constant(stack.side)};
  for (int i = 0; i < stack.count; ++i) {
    const double mass = i + 1 < stack.count ? stack.mass : stack.top_mass;
    world.add(scenes::loose(scenes::at(0, 0, i * stack.side), box, mass, 0.7));
  }
  const Vector3 start = scenes::origin(world, stack.count - 1).position;
  scenes::run(world, 10, h);
  return (scenes::origin(world, stack.count - 1).position - start).norm();
}

double their_stack(double h, const Stack& stack, bool stiff) {
  std::string bodies = "<geom type='plane' size='9 9 1' friction='0.7 0 0'/>";
  for (int i = 0; i < stack.count; ++i) {
    bodies += text(
        "<body pos='0 0 {1}'><freejoint/><geom type='box' size='{2} {2} {2}' mass='{3}' "
        "friction='0.7 0 0'/></body>",
        {(i + 0.5) * stack.side, stack.side / 2,
         i + 1 < stack.count ? stack.mass : stack.top_mass});
  }
  Model model(bodies, h, Vector3(0, 0, -earth));
  if (stiff) model.stiffen();
  const Vector3 start = model.place(stack.count);
  model.run(10);
  return (model.place(stack.count) - start).norm();
}

// ---- Cost of a substep.

scene::Entity robot(double x, double y) {
  using scenes::at;
  using scenes::link;
  const scene::Cylinder wheel{0.02, 0.006};
  scene::Entity entity = scenes::prototype(
      "robot", at(x, y, 0), true,
      {link("base", scene::Cylinder{0.05, 0.03}, 0.3, at(0, 0, 0.012)), link("left", wheel, 0.02),
       link("right", wheel, 0.02), link("front", scene::Sphere{0.005}, 0.01),
       link("back", scene::Sphere{0.005}, 0.01)});
  const auto join = [&](int child, scene::JointType type, const Pose& in_base) {
    scene::Joint joint = scenes::joint(type, Vector3::UnitZ(), in_base, {});
    joint.id = entity.links[child].id;
    joint.child = child;
    entity.joints.push_back(joint);
  };
  const auto turned = [](double side) { return scenes::about({1, 0, 0}, -side * M_PI / 2); };
  join(1, scene::JointType::revolute, {{0, 0.055, 0.008}, turned(1)});
  join(2, scene::JointType::revolute, {{0, -0.055, 0.008}, turned(-1)});
  join(3, scene::JointType::fixed, at(0.035, 0, -0.011));
  join(4, scene::JointType::fixed, at(-0.035, 0, -0.011));
  return scenes::with_friction(std::move(entity), 0.7);
}

constexpr double lattice = 0.4;  // [m]

Vector3 place_of(int i, int count) {
  const int across = static_cast<int>(std::ceil(std::sqrt(count)));
  return {lattice * (i % across), lattice * (i / across), 0};
}

/// Microseconds of CPU time per substep.
double time_of(int substeps, const std::function<void()>& step) {
  for (int i = 0; i < 10; ++i) step();
  const double start = cpu_seconds();
  for (int i = 0; i < substeps; ++i) step();
  return 1e6 * (cpu_seconds() - start) / substeps;
}

double our_robots(int count, int substeps) {
  World world(scenes::newton(true), 0.01);
  for (int i = 0; i < count; ++i) {
    const Vector3 at = place_of(i, count);
    world.add(robot(at.x(), at.y()));
    for (int wheel = 0; wheel < 2; ++wheel) {
      const physics::JointIndex joint = world.joint(i, wheel);
      world.add_motor(joint, scene::JointMode::velocity, 0.05);
      world.set_target(joint, wheel ? -3 - 0.1 * (i % 7) : 3);
    }
  }
  return time_of(substeps, [&] { world.step(); });
}

double their_robots(int count, int substeps) {
  std::string bodies = "<geom type='plane' size='99 99 1'/>", motors;
  for (int i = 0; i < count; ++i) {
    const Vector3 at = place_of(i, count);
    bodies += yardstick::robot(at, i);
    for (const char* side : {"l", "r"}) {
      motors += text("<velocity joint='{1}", {double(i)}) + side + "' kv='0.005'/>";
    }
  }
  Model model(bodies, 0.01, Vector3(0, 0, -earth), "implicit", motors);
  for (int i = 0; i < count; ++i) {
    model.data->ctrl[2 * i] = 3, model.data->ctrl[2 * i + 1] = 3 + 0.1 * (i % 7);
  }
  return time_of(substeps, [&] { model.step(); });
}

double our_boxes(int count, int substeps) {
  World world(scenes::newton(true), 0.01);
  for (int i = 0; i < count; ++i) {
    world.add(scenes::loose({place_of(i, count), math::Quaternion::Identity()}, scenes::cube, 1));
  }
  if (substeps > 10) {
    for (int i = 0; i < 100; ++i) world.step();  // until they sleep
  }
  return time_of(substeps, [&] { world.step(); });
}

double their_boxes(int count, int substeps) {
  std::string bodies = "<geom type='plane' size='99 99 1'/>";
  for (int i = 0; i < count; ++i) {
    const Vector3 at = place_of(i, count);
    bodies += text(
        "<body pos='{1} {2} 0.05'><freejoint/>"
        "<geom type='box' size='0.05 0.05 0.05' mass='1'/></body>",
        {at.x(), at.y()});
  }
  Model model(bodies, 0.01, Vector3(0, 0, -earth));
  return time_of(substeps, [&] { model.step(); });
}

// ---- Tables.

using Measure = std::function<double(double)>;  // of the substep's length

void table(const char* title, const std::vector<std::pair<const char*, Measure>>& rows) {
  std::printf("\n%s\n\n|", title);
  for (const int rate : rates) std::printf(" | %d Hz", rate);
  std::printf(" |\n|---|---|---|---|---|---|---|\n");
  for (const auto& [name, measure] : rows) {
    std::printf("| %s", name);
    for (const int rate : rates) std::printf(" | %.1e", measure(1.0 / rate)), std::fflush(stdout);
    std::printf(" |\n");
  }
}

/// A function of the substep's length and more, with the rest chosen.
template <class Function, class... Rest>
Measure with(Function function, Rest... rest) {
  return [=](double h) { return function(h, rest...); };
}

void errors() {
  table("Box on a slope of 0.35 rad, friction 0.3, 3 s: distance over a t^2 / 2, less 1",
        {{"ours", our_slide},
         {"MuJoCo", with(their_slide, false)},
         {"MuJoCo, stiff", with(their_slide, true)}});
  table("Slider of 3 m/s, friction 0.3: highest gap [m]",
        {{"ours", our_gap},
         {"MuJoCo", with(their_gap, false)},
         {"MuJoCo, stiff", with(their_gap, true)}});
  table("Asymmetric body, 4 rad/s about its middle axis, 10 s: relative change of energy",
        {{"ours", our_tumbling},
         {"MuJoCo, Euler", with(their_tumbling, "Euler")},
         {"MuJoCo, RK4", with(their_tumbling, "RK4")}});
  table("Double pendulum, 10 s: worst change of energy over what falls",
        {{"ours", with(our_chain, 2, 10)},
         {"MuJoCo, Euler", with(their_chain, 2, 10, "Euler")},
         {"MuJoCo, RK4", with(their_chain, 2, 10, "RK4")}});
  table("Chain of 10 links, 2 s: worst change of energy over what falls",
        {{"ours", with(our_chain, 10, 2)},
         {"MuJoCo, Euler", with(their_chain, 10, 2, "Euler")},
         {"MuJoCo, RK4", with(their_chain, 10, 2, "RK4")}});
  table("Tower of 10 boxes of 1 cm, 10 s: how far the top moves [m]",
        {{"ours", with(our_stack, tower)},
         {"MuJoCo", with(their_stack, tower, false)},
         {"MuJoCo, stiff", with(their_stack, tower, true)}});
  table("1 000 kg on 1 kg, boxes of 10 cm, 10 s: how far the top moves [m]",
        {{"ours", with(our_stack, heavy)},
         {"MuJoCo", with(their_stack, heavy, false)},
         {"MuJoCo, stiff", with(their_stack, heavy, true)}});
}

void costs() {
  std::printf("| per substep of 10 ms | ours [us each] | MuJoCo [us each] |\n|---|---|---|\n");
  for (const int count : {1, 16, 64}) {
    const int substeps = 2000 / count + 20;
    std::printf("| %d driving robots on two wheels | %.2f | %.2f |\n", count,
                our_robots(count, substeps) / count, their_robots(count, substeps) / count);
    std::fflush(stdout);
  }
  for (const int count : {1, 16, 64}) {
    std::printf("| %d boxes on the floor, awake | %.2f | %.2f |\n", count,
                our_boxes(count, 10) / count, their_boxes(count, 10) / count);
    std::fflush(stdout);
  }
  for (const int count : {64, 1024}) {
    std::printf("| %d boxes on the floor, asleep | %.3f | never |\n", count,
                our_boxes(count, 1000) / count);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  if (what == "robots" && argc == 4) {
    const int count = std::stoi(argv[2]), substeps = 2000 / count + 20;
    const bool is_ours = argv[3] == std::string_view("ours");
    std::printf("%.3f\n",
                (is_ours ? our_robots(count, substeps) : their_robots(count, substeps)) / count);
    return 0;
  }
  what == "cost" ? costs() : errors();
}
