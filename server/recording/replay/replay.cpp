// SPDX-License-Identifier: MIT
#include "recording/replay/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "recording/inputs.h"
#include "recording/replay/recording_file.h"
#include "scene/reader.h"
#include "simulation/joints.h"
#include "simulation/show.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::replay {
namespace {

constexpr std::size_t most_spawned_bytes = std::size_t{64}
                                           << 20;  // since a reset, models written out
constexpr std::size_t most_snapshots = 1024;       // as the server keeps
constexpr std::size_t most_snapshot_bytes = std::size_t{1} << 30;  // of all of them
constexpr double farthest = 1e6;                                   // [m], as in scenes

/// Sets a joint, or tells why it can't be.
std::optional<simulation::JointFault> set_joint(simulation::Simulation& world, std::size_t entity,
                                                const v1::Act::SetJoint& set) {
  const simulation::JointMotion wanted{set.joint(), set.position(), set.velocity()};
  auto fault = simulation::fault_of(world, entity, wanted);
  if (!fault) simulation::set_joint(world, entity, wanted);
  return fault;
}

}  // namespace

Replay::Replay(World world, scene::OpenFile open, Source source)
    : world_(world), open_(std::move(open)), source_(std::move(source)) {}

void Replay::fail(const std::string& what) const {
  throw RecordingError(fmt::format("the recording's inputs of tick {}{}: {}", tick_,
                                   epoch_ > 0 ? fmt::format(" (epoch {})", epoch_) : "", what));
}

bool Replay::advance(timing::Stopwatch* watch) {
  const bool is_first = inputs_ == nullptr;
  if (!is_first && !acted_) act();
  const v1::Inputs* next = source_();
  if (!next) return false;
  if (!is_first && next->epoch() == epoch_) {
    if (!has_commands_) fail("they have no commands, and yet there is a next tick");
    if (!links_) world_.simulation.step(watch);
  }
  inputs_ = next;
  epoch_ = next->epoch();
  tick_ = next->tick();
  has_commands_ = next->has_commands();
  acted_ = false;
  repeat(next->acts_before());
  if (links_) show_state();
  if (world_.simulation.state().tick != tick_) {
    fail(fmt::format("the tick {} was expected", world_.simulation.state().tick));
  }
  hash_ = links_ ? next->hash() : world_.simulation.hash();
  return true;
}

void Replay::show_state() {
  const auto* links = links_();
  if (!links) fail("there are no poses in /state for them");
  try {
    simulation::show(world_.simulation, tick_, *links);
  } catch (const simulation::SnapshotError& error) {
    fail(error.what());
  }
}

bool Replay::is_same() const { return inputs_->hash() == hash_; }

void Replay::act() {
  acted_ = true;
  repeat(inputs_->acts());
  if (!inputs_->acts().empty() && !links_) hash_ = world_.simulation.hash();
  if (!has_commands_) return;
  simulation::Simulation& simulation = world_.simulation;
  const auto fault = recording::unpack(inputs_->commands(), simulation.layout(), simulation.state(),
                                       simulation.commands(), commands_);
  if (fault) fail(*fault);
  simulation.commands() = commands_;
}

void Replay::repeat(const Acts& acts) {
  for (const v1::Act& act : acts) {
    apply(act);
    if (told_) told_(act);
  }
}

void Replay::apply(const v1::Act& act) {
  switch (act.act_case()) {
    case v1::Act::kMove:
      return move(act.move());
    case v1::Act::kSetJoint:
      if (const auto fault = set_joint(world_.simulation, entity_named(act.set_joint().entity()),
                                       act.set_joint())) {
        fail(fmt::format("a joint cannot be set: {}", fault->text));
      }
      ++changes_;
      return;
    case v1::Act::kSpawn:
      return spawn(act.spawn().xml());
    case v1::Act::kRemove:
      return remove(act.remove().entity());
    case v1::Act::kReset:
      return reset(act.reset().seed());
    case v1::Act::kSnapshot:
      return snapshot(act.snapshot().name());
    case v1::Act::kRestore:
      return restore(act.restore());
    case v1::Act::kPause:
    case v1::Act::kResume:
      return;
    default:
      fail("they have an act that this version cannot repeat; use the version that recorded it");
  }
}

/// Ids are used again: an entity that is in the world is the last one of its id.
std::optional<std::size_t> Replay::find(const std::string& id) {
  const auto& entities = world_.simulation.layout().entities;
  for (; names_.entities < entities.size(); ++names_.entities) {
    names_.last[entities[names_.entities].id] = names_.entities;
  }
  const auto found = names_.last.find(id);
  if (found == names_.last.end() || world_.simulation.state().is_absent(found->second))
    return std::nullopt;
  return found->second;
}

std::size_t Replay::entity_named(const std::string& id) {
  if (const auto entity = find(id)) return *entity;
  fail(fmt::format("there is no entity '{}'", id));
}

void Replay::move(const v1::Act::Move& move) {
  const std::size_t entity = entity_named(move.entity());
  math::Pose pose = world_.simulation.state().origins[entity];
  const auto& p = move.position();
  const bool is_near = std::ranges::all_of(p, [](double v) { return std::abs(v) <= farthest; });
  if (p.size() != 3 || !is_near) fail(fmt::format("'{}' is moved to no position", move.entity()));
  pose.position = {p[0], p[1], p[2]};
  if (const auto& q = move.orientation(); !q.empty()) {
    if (q.size() == 4) pose.orientation = math::Quaternion(q[0], q[1], q[2], q[3]);
    const double norm = pose.orientation.norm();  // taken as it is: its bits count
    if (q.size() != 4 || !(std::abs(norm - 1) < 1e-9)) {
      fail(
          fmt::format("'{}' is moved to an orientation that is no unit quaternion", move.entity()));
    }
  }
  ++changes_;
  world_.simulation.move(entity, pose);
}

void Replay::remove(const std::string& id) {
  ++changes_;
  world_.simulation.remove(entity_named(id));
}

void Replay::spawn(const std::string& xml) {
  const auto& entities = world_.simulation.layout().entities;
  const auto is_taken = [&](const std::string& id) { return find(id).has_value(); };
  const std::size_t left = most_spawned_bytes - std::min(most_spawned_bytes, spawned_bytes_);
  scene::Addition addition = world_.additions.read(xml, world_.scene, left, is_taken, open_);
  try {
    if (!addition.ok()) throw scene::SceneError(std::move(addition.problems));
    spawned_bytes_ += addition.size;
    spawned_sizes_[xml] = addition.size;
    ++changes_;
    if (links_) {  // wherever others were when the world was built
      simulation::repeat(world_.simulation, world_.scene,
                         {simulation::WorldEdit::Kind::spawn, tick_, entities.size(),
                          std::make_shared<const scene::Entity>(std::move(addition.entity)), xml});
    } else {
      world_.simulation.spawn(world_.scene, addition.entity, xml);
    }
  } catch (const scene::SceneError& error) {
    fail(fmt::format("an entity cannot be spawned: {}", error.what()));
  }
}

void Replay::reset(std::uint64_t seed) {
  if (seed == 0) fail("they reset the world with the seed 0");
  try {
    world_.simulation.reset(world_.scene, {seed, {}});
  } catch (const scene::SceneError& error) {
    fail(fmt::format("the world cannot be reset: {}", error.what()));
  }
  world_.seed = seed;
  names_ = {};
  spawned_bytes_ = 0;
  ++changes_;
}

void Replay::snapshot(const std::string& name) {
  simulation::Snapshot& place = snapshots_[name];
  snapshots_size_ -= place.size();
  if (links_) {  // who is in the world; poses come with the states
    place = {};
    place.seed = world_.seed;
    place.history = world_.simulation.history();
  } else {
    place = world_.simulation.snapshot();
  }
  snapshots_size_ += place.size();
  if (snapshots_.size() > most_snapshots) {
    fail(fmt::format("they take more than {} snapshots", most_snapshots));
  }
  if (snapshots_size_ > most_snapshot_bytes) {
    fail(fmt::format("they take snapshots of more than {} MiB", most_snapshot_bytes >> 20));
  }
}

void Replay::restore(const v1::Act::Restore& restore) {
  const auto found = snapshots_.find(restore.name());
  const bool is_file = !restore.file().empty() && open_snapshot_;
  if (!is_file && found == snapshots_.end()) {
    fail(fmt::format("they restore '{}', of which this recording has no snapshot", restore.name()));
  }
  try {
    restore_to(is_file ? open_snapshot_(restore.file()) : found->second);
  } catch (const simulation::SnapshotError& error) {
    fail(error.what());
  }
}

void Replay::restore_to(const simulation::Snapshot& snapshot) {
  common_robots_ = simulation::common_robots(world_.simulation.history(), snapshot.history,
                                             world_.simulation.layout());
  if (links_) {
    world_.simulation.reset(world_.scene, {snapshot.seed, {}});
    for (const simulation::WorldEdit& act : snapshot.history.edits) {
      simulation::repeat(world_.simulation, world_.scene, act);
    }
  } else {
    world_.simulation.restore(world_.scene, snapshot);
  }
  world_.seed = snapshot.seed;
  names_ = {};
  spawned_bytes_ = 0;
  for (const simulation::WorldEdit& act : snapshot.history.edits) {
    const auto size = spawned_sizes_.find(act.xml);
    if (act.kind == simulation::WorldEdit::Kind::spawn)
      spawned_bytes_ += size == spawned_sizes_.end() ? act.xml.size() : size->second;
  }
  ++changes_;
}

}  // namespace ziggurat::replay
