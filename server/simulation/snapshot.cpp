// SPDX-License-Identifier: MIT
#include "simulation/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "simulation/parts.h"
#include "world/archive.h"

namespace ziggurat::simulation {
namespace {

/// Whether two worlds of one scene and seed have the same entities in the same places.
bool same_entities(const History& one, const History& other) {
  return std::ranges::equal(one.edits, other.edits, [](const WorldEdit& a, const WorldEdit& b) {
    return a.kind == b.kind && a.entity == b.entity && a.spawned == b.spawned;
  });
}

}  // namespace

std::optional<std::string> fault_of_snapshot_name(std::string_view name) {
  constexpr std::size_t longest = 64;
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.';
  };
  const bool is_name = !name.empty() && name.size() <= longest && name[0] != '.' &&
                       std::ranges::all_of(name, is_allowed);
  if (is_name) return std::nullopt;
  return fmt::format(
      "The name of a snapshot has 1 to {} letters, digits, '-', '_' and '.', and does not begin "
      "with '.'",
      longest);
}

std::size_t common_robots(const History& now, const History& then, const world::Layout& layout) {
  std::size_t entities = layout.entities.size();
  const auto is_same = [](const WorldEdit& a, const WorldEdit& b) {
    return a.kind == b.kind && a.tick == b.tick && a.entity == b.entity && a.xml == b.xml;
  };
  const auto [part, other] = std::ranges::mismatch(now.edits, then.edits, is_same);
  for (auto edit = part; edit != now.edits.end(); ++edit) {
    if (edit->kind == WorldEdit::Kind::spawn) entities = std::min(entities, edit->entity);
  }
  return static_cast<std::size_t>(std::ranges::count_if(
      layout.robots, [&](const world::RobotLayout& robot) { return robot.entity < entities; }));
}

std::size_t Snapshot::size() const {
  std::size_t size = state.size();
  for (const WorldEdit& edit : history.edits) size += sizeof edit + edit.xml.size();
  return size;
}

void Parts::archive(math::Archive& archive) {
  archive("physics", physics);
  world::archive(archive, layout, state);
  world::archive(archive, layout, state, observations);
  world::archive(archive, layout, commands);
  archive("devices", devices);
  if (!archive.reads()) return;
  archive.require(archive.left() == 0, "is followed by more bytes");
  list_contacts(lists_contacts);
  look_around();
}

const History& Simulation::history() const { return parts_->history; }

Snapshot Simulation::snapshot() const {
  Parts& p = *parts_;
  Snapshot snapshot;
  snapshot.seed = p.seed;
  snapshot.tick = p.state.tick;
  snapshot.hash = hash();
  snapshot.history = p.history;
  snapshot.is_checked = true;
  snapshot.state.reserve(p.archive_size);
  auto archive = math::Archive::writer(snapshot.state);
  p.archive(archive);
  p.archive_size = snapshot.state.size();
  return snapshot;
}

void Parts::repeat_edit(const scene::Scene& scene, const WorldEdit& edit) {
  const std::size_t entities = layout.entities.size();
  const bool spawns = edit.kind == WorldEdit::Kind::spawn;
  if (spawns ? edit.entity != entities || !edit.spawned
             : edit.entity >= entities || state.is_absent(edit.entity)) {
    throw SnapshotError("An entity of the snapshot is not in the scene.");
  }
  spawns ? grow(scene, *edit.spawned) : remove(edit.entity);
}

/// A state with the random streams that this world has now.
std::vector<std::byte> Parts::with_own_streams(const std::vector<std::byte>& given) {
  const auto write = [this](std::vector<math::Archive::Place>& streams) {
    std::vector<std::byte> bytes;
    auto archive = math::Archive::writer(bytes, &streams);
    this->archive(archive);
    std::erase_if(streams, [](const auto& place) { return !place.path.ends_with("/engine"); });
    return bytes;
  };
  std::vector<math::Archive::Place> own_streams, streams;
  const std::vector<std::byte> own = write(own_streams);
  auto archive = math::Archive::reader(given);
  this->archive(archive);
  std::vector<std::byte> mixed = write(streams);
  if (!std::ranges::equal(own_streams, streams, {}, &math::Archive::Place::path,
                          &math::Archive::Place::path)) {
    throw SnapshotError("The snapshot has other random streams than the scene.");
  }
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const auto from = own.begin() + static_cast<std::ptrdiff_t>(own_streams[i].offset);
    std::copy_n(from, sizeof(std::uint64_t) * (std::mt19937_64::state_size + 1),
                mixed.begin() + static_cast<std::ptrdiff_t>(streams[i].offset));
  }
  return mixed;
}

void Parts::repeat(const scene::Scene& scene, const Snapshot& snapshot) {
  for (const WorldEdit& edit : snapshot.history.edits) repeat_edit(scene, edit);
  std::vector<std::byte> mixed;
  if (seed != snapshot.seed) mixed = with_own_streams(snapshot.state);
  auto archive = math::Archive::reader(mixed.empty() ? snapshot.state : mixed);
  this->archive(archive);
  history = snapshot.history;
}

void Simulation::restore(const scene::Scene& scene, const Snapshot& snapshot,
                         std::optional<std::uint64_t> seed) {
  Parts& p = *parts_;
  if (!seed && snapshot.is_checked && p.seed == snapshot.seed &&
      same_entities(p.history, snapshot.history)) {
    auto archive = math::Archive::reader(snapshot.state);
    p.archive(archive);
    p.history = snapshot.history;
    return;
  }
  world::Layout before = *layout_;
  try {
    auto fresh =
        std::make_unique<Parts>(scene, Options{seed.value_or(snapshot.seed), {}}, *layout_);
    fresh->repeat(scene, snapshot);
    if (world::hash(fresh->state, fresh->observations) != snapshot.hash) {
      throw SnapshotError("The snapshot's state is not the one that its hash is of.");
    }
    fresh->lists_rays = p.lists_rays;
    fresh->list_contacts(p.lists_contacts);
    fresh->physics.set_threads(threads_);
    parts_ = std::move(fresh);
  } catch (const math::ArchiveError& error) {
    *layout_ = std::move(before);
    throw SnapshotError(std::string("The snapshot can't be read: ") + error.what());
  } catch (...) {
    *layout_ = std::move(before);
    throw;
  }
}

std::string Simulation::first_difference(const Snapshot& snapshot) const {
  std::vector<std::byte> now;
  std::vector<math::Archive::Place> places;
  auto archive = math::Archive::writer(now, &places);
  parts_->archive(archive);
  const auto [here, there] = std::ranges::mismatch(now, snapshot.state);
  if (here == now.end() && there == snapshot.state.end()) return {};
  return math::field_at(places, static_cast<std::size_t>(here - now.begin()));
}

}  // namespace ziggurat::simulation
