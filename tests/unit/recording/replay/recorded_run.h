// SPDX-License-Identifier: MIT
#pragma once
// A run in memory: acts and commands of every kind, recorded as `--record` does it.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "recording/inputs.h"
#include "recording/replay/embedded_files.h"
#include "recording/replay/replay.h"
#include "recording/replay/scene.h"
#include "simulation/joints.h"
#include "simulation/simulation.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::replay::testing {

/// A robot with an arm, whose model is in a file of its own, and two boxes that fall on a floor.
inline EmbeddedFiles files() {
  EmbeddedFiles files;
  files.add(
      "scenes/small.argos",
      R"(<argos><include file="models/arm.xml"/><framework><experiment ticks_per_second="10" )"
      R"(random_seed="3"/></framework><controllers><external_controller id="c"><actuators>)"
      R"(<joints implementation="default"><joint id="hinge" mode="velocity" max_impulse="20"/></joints>)"
      R"(<radios implementation="default"/></actuators><sensors>)"
      R"(<joints implementation="default"><joint id="hinge" mode="position"/></joints>)"
      R"(<radios implementation="default"/><positioning implementation="default"/></sensors>)"
      R"(<params/></external_controller></controllers><arena size="9,9,9">)"
      R"(<prototype id="r" model="arm"><body position="1,0,0"/><controller config="c"/></prototype>)"
      R"(<box id="low" size=".4,.4,.4" movable="true" mass="1"><body position="0,0,0"/></box>)"
      R"(<box id="high" size=".2,.2,.2" movable="true" mass="1"><body position="0.05,0,0.5"/>)"
      R"(</box></arena><physics_engines><dynamics3d id="d" iterations="4"><floor/>)"
      R"(<gravity g="9.8"/></dynamics3d></physics_engines><media><radio id="air"/>)"
      R"(<led id="leds"/></media></argos>)");
  files.add(
      "scenes/models/arm.xml",
      R"(<ziggurat-models><models><prototype id="arm" movable="false"><links ref="base"><link id="base" )"
      R"(geometry="box" size=".1,.1,.1" mass="1"/><link id="arm" geometry="box" )"
      R"(size=".5,.1,.1" mass="1"/></links><joints><joint id="hinge" type="revolute" )"
      R"(axis="0,1,0"><parent link="base" position="0,0,.4"/><child link="arm" )"
      R"(position="-.25,0,0"/></joint></joints><devices><radios medium="air"><radio id="rx" )"
      R"(anchor="base" position="0,0,.1" range="9"/></radios></devices></prototype></models></ziggurat-models>)");
  return files;
}

inline v1::RunStart start() {
  v1::RunStart start;
  start.set_scene("scenes/small.argos");
  start.set_seed(3);
  return start;
}

/// Recorded inputs and states of a run.
struct Recording {
  std::vector<v1::Inputs> inputs;
  std::vector<std::vector<world::LinkState>> links;

  Replay::Source source() const {
    return [this, i = std::size_t{0}]() mutable -> const v1::Inputs* {
      return i < inputs.size() ? &inputs[i++] : nullptr;
    };
  }
};

/// A world of its own, read from the embedded files.
struct OwnWorld {
  EmbeddedFiles embedded = files();
  scene::OpenScene opened = read_scene(start(), embedded);
  std::uint64_t seed = 3;
  simulation::Simulation simulation{opened.scene, {seed, {}}};

  World world() { return {opened.scene, opened.additions, simulation, seed}; }
  Replay replay(const Recording& recording) {
    return {world(), embedded.opener(), recording.source()};
  }
};

/// Runs a world and records it.
class Recorder {
 public:
  OwnWorld own;
  Recording recording;

  Recorder() { publish(); }
  simulation::Simulation& simulation() { return own.simulation; }

  void step() {
    packer_.pack(simulation().commands(), *inputs().mutable_commands());
    simulation().step();
    publish();
  }
  std::size_t entity(const std::string& id) {
    const auto& all = simulation().layout().entities;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].id == id && !simulation().state().is_absent(i)) return i;
    }
    ADD_FAILURE() << id;
    return 0;
  }
  void move(const std::string& id, const math::Pose& pose) {
    auto& move = *inputs().add_acts()->mutable_move();
    move.set_entity(id);
    for (const double v : pose.position) move.add_position(v);
    const math::Quaternion& q = pose.orientation;
    for (const double v : {q.w(), q.x(), q.y(), q.z()}) move.add_orientation(v);
    simulation().move(entity(id), pose);
  }
  void set_joint(const std::string& id, const simulation::JointMotion& motion) {
    auto& set = *inputs().add_acts()->mutable_set_joint();
    set.set_entity(id);
    set.set_joint(motion.joint);
    set.set_position(motion.position);
    set.set_velocity(motion.velocity);
    simulation::set_joint(simulation(), entity(id), motion);
  }
  void spawn(const std::string& xml) {
    inputs().add_acts()->mutable_spawn()->set_xml(xml);
    const auto addition = own.opened.additions.read(xml, own.opened.scene, 1 << 20,
                                                    [](const auto&) { return false; });
    for (const auto& problem : addition.problems) ADD_FAILURE() << scene::to_string(problem);
    simulation().spawn(own.opened.scene, addition.entity);
  }
  void remove(const std::string& id) {
    inputs().add_acts()->mutable_remove()->set_entity(id);
    simulation().remove(entity(id));
  }
  void reset(std::uint64_t seed) {
    inputs().add_acts()->mutable_reset()->set_seed(seed);
    simulation().reset(own.opened.scene, {seed, {}});
    ++epoch_;
    publish();
  }
  void snapshot(const std::string& name) {
    inputs().add_acts()->mutable_snapshot()->set_name(name);
    snapshot_ = simulation().snapshot();
  }
  void restore(const std::string& name) {
    inputs().add_acts()->mutable_restore()->set_name(name);
    simulation().restore(own.opened.scene, snapshot_);
    ++epoch_;
    publish();
  }
  v1::Inputs& inputs() { return recording.inputs.back(); }

 private:
  void publish() {
    v1::Inputs& next = recording.inputs.emplace_back();
    next.set_epoch(epoch_);
    next.set_tick(simulation().state().tick);
    next.set_hash(simulation().hash());
    recording.links.push_back(simulation().state().links);
  }

  recording::CommandPacker packer_;
  simulation::Snapshot snapshot_;
  std::uint64_t epoch_ = 0;
};

/// Commands, a move, spawns, a removal, a reset to another seed, and more commands.
inline Recording eventful_run() {
  Recorder run;
  const std::string hello = "hello";
  for (int i = 0; i < 8; ++i) {
    run.simulation().commands().joint_targets.at(0) = 0.3 * i;
    run.simulation().commands().radio_messages.add(
        0, {reinterpret_cast<const std::uint8_t*>(hello.data()), hello.size()});
    run.step();
  }
  math::Pose pose;
  pose.position = {1, 2, 0.5};
  pose.orientation = math::Quaternion(1, 2, 3, 4).normalized();
  run.move("high", pose);
  run.spawn(
      R"(<prototype id="s" model="arm"><body position="3,0,0"/><controller config="c"/></prototype>)");
  run.spawn(
      R"(<box id="extra" size=".1,.1,.1" movable="true" mass="1"><body position="-2,0,1"/></box>)");
  run.step();
  run.simulation().commands().joint_targets.at(1) = -2;
  for (int i = 0; i < 4; ++i) run.step();
  run.inputs().add_acts()->mutable_pause();
  run.remove("s");
  run.inputs().add_acts()->mutable_resume();
  for (int i = 0; i < 3; ++i) run.step();
  run.reset(7);
  run.simulation().commands().joint_targets.at(0) = 1;
  for (int i = 0; i < 5; ++i) run.step();
  return std::move(run.recording);
}

}  // namespace ziggurat::replay::testing
