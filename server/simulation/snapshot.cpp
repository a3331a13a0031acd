#include "simulation/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "simulation/parts.h"
#include "world/archive.h"

namespace ziggurat::simulation {
namespace {

/// Size of all commands that are kept to repeat a run [bytes].
constexpr std::size_t longest_history = std::size_t{256} << 20;

/// Whether two worlds of one scene and seed have the same entities in the same places.
bool same_entities(const History& one, const History& other) {
  return std::ranges::equal(one.edits, other.edits, [](const WorldEdit& a, const WorldEdit& b) {
    return a.kind == b.kind && a.entity == b.entity && a.spawned == b.spawned;
  });
}

void write_commands(const world::Layout& layout, world::Commands& commands,
                    std::vector<std::byte>& bytes) {
  bytes.clear();
  auto archive = math::Archive::writer(bytes);
  world::archive(archive, layout, commands);
}

void read_commands(std::span<const std::byte> bytes, const world::Layout& layout,
                   world::Commands& commands) {
  auto archive = math::Archive::reader(bytes);
  world::archive(archive, layout, commands);
}

}  // namespace

std::optional<std::string> fault_of_snapshot_name(std::string_view name) {
  constexpr std::size_t longest = 64;
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
  };
  const bool is_name = !name.empty() && name.size() <= longest && name[0] != '.' && std::ranges::all_of(name, is_allowed);
  if (is_name) return std::nullopt;
  return fmt::format("The name of a snapshot has 1 to {} letters, digits, '-', '_' and '.', and does not begin with '.'", longest);
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
  std::size_t size = state.size() + commands.size() + history.size;
  for (const WorldEdit& edit : history.edits) size += sizeof edit + edit.xml.size();
  return size + history.commands.size() * sizeof(Commanded);
}

void Simulation::Parts::archive(math::Archive& archive) {
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

/// A run that goes on for longer than there is room for can't go back.
void Simulation::Parts::note_commands() {
  if (has_archive || history.size > longest_history) return;
  write_commands(layout, commands, commanding);
  // Commands that last for one step must be written down again, though they are the same.
  const bool lasts = commands.radio_messages.entries.empty() && commands.pushes.empty();
  if (lasts && commanding == commanded) return;
  history.commands.push_back({state.tick, commanding});
  history.size += commanding.size();
  std::swap(commanded, commanding);
}

void Simulation::Parts::note_move(std::size_t entity, const math::Pose& pose) {
  if (has_archive || history.size > longest_history) return;
  history.edits.push_back({WorldEdit::Kind::move, state.tick, entity, pose, {}, {}});
  history.size += sizeof(WorldEdit);
}

const History& Simulation::history() const { return parts_->history; }

Snapshot Simulation::snapshot() const {
  Parts& p = *parts_;
  if (p.history.size > longest_history) {
    throw SnapshotError(fmt::format(
        "There are too many commands and moves since the start to repeat them: more than {} MiB. Snapshots of "
        "long runs need solver=\"newton\".",
        longest_history >> 20));
  }
  Snapshot snapshot;
  snapshot.seed = p.seed;
  snapshot.tick = p.state.tick;
  snapshot.hash = hash();
  snapshot.history = p.history;
  snapshot.is_checked = true;
  if (p.has_archive) {
    snapshot.state.reserve(p.archive_size);
    auto archive = math::Archive::writer(snapshot.state);
    p.archive(archive);
    p.archive_size = snapshot.state.size();
  } else {
    write_commands(p.layout, p.commands, snapshot.commands);
  }
  return snapshot;
}

void Simulation::Parts::repeat_edit(const scene::Scene& scene, const WorldEdit& edit,
                                   world::Layout& grown) {
  const std::size_t entities = grown.entities.size();
  const bool spawns = edit.kind == WorldEdit::Kind::spawn;
  if (spawns ? edit.entity != entities || !edit.spawned
             : edit.entity >= entities || state.is_absent(edit.entity)) {
    throw SnapshotError("An entity of the snapshot is not in the scene.");
  }
  switch (edit.kind) {
    case WorldEdit::Kind::spawn:
      return grow(scene, *edit.spawned, grown);
    case WorldEdit::Kind::remove:
      return remove(edit.entity);
    case WorldEdit::Kind::move:
      return move(edit.entity, edit.pose);
  }
}

/// A state with the random streams that this world has now.
std::vector<std::byte> Simulation::Parts::with_own_streams(const std::vector<std::byte>& given) {
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

void Simulation::Parts::repeat(const scene::Scene& scene, const Snapshot& snapshot,
                               world::Layout& grown, const std::function<void()>& tell) {
  auto edit = snapshot.history.edits.begin();
  const auto end = snapshot.history.edits.end();
  if (has_archive) {
    for (; edit != end; ++edit) repeat_edit(scene, *edit, grown);
    std::vector<std::byte> mixed;
    if (seed != snapshot.seed) mixed = with_own_streams(snapshot.state);
    auto archive = math::Archive::reader(mixed.empty() ? snapshot.state : mixed);
    this->archive(archive);
  } else {
    auto change = snapshot.history.commands.begin();
    for (;; step()) {
      if (tell) tell();
      for (; edit != end && edit->tick == state.tick; ++edit) repeat_edit(scene, *edit, grown);
      if (state.tick == snapshot.tick) break;
      const bool changes =
          change != snapshot.history.commands.end() && change->tick == state.tick;
      if (changes) read_commands((change++)->bytes, layout, commands);
    }
    read_commands(snapshot.commands, layout, commands);
  }
  history = snapshot.history;
  commanded = history.commands.empty() ? std::vector<std::byte>() : history.commands.back().bytes;
}

void Simulation::restore(const scene::Scene& scene, const Snapshot& snapshot,
                         std::optional<std::uint64_t> seed, const std::function<void()>& tell) {
  Parts& p = *parts_;
  const bool copies = p.has_archive;
  if (seed && (!copies || snapshot.state.empty())) {
    throw SnapshotError(
        "Only a world with solver=\"newton\" can go on from a state with other values or another seed.");
  }
  if (copies != snapshot.commands.empty() || copies == snapshot.state.empty()) {
    throw SnapshotError("The snapshot is of a scene with another solver.");
  }
  if (!seed && copies && snapshot.is_checked && p.seed == snapshot.seed &&
      same_entities(p.history, snapshot.history)) {
    auto archive = math::Archive::reader(snapshot.state);
    p.archive(archive);
    p.history = snapshot.history;
    return;
  }
  world::Layout before = *layout_;
  try {
    auto fresh = std::make_unique<Parts>(scene, Options{seed.value_or(snapshot.seed), {}}, *layout_);
    fresh->repeat(scene, snapshot, *layout_, tell);
    if (world::hash(fresh->state, fresh->observations) != snapshot.hash) {
      throw SnapshotError("The snapshot's state is not the one that its hash is of.");
    }
    fresh->lists_rays = p.lists_rays;
    fresh->list_contacts(p.lists_contacts);
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
  if (!parts_->has_archive) return {};
  std::vector<std::byte> now;
  std::vector<math::Archive::Place> places;
  auto archive = math::Archive::writer(now, &places);
  parts_->archive(archive);
  const auto [here, there] = std::ranges::mismatch(now, snapshot.state);
  if (here == now.end() && there == snapshot.state.end()) return {};
  return math::field_at(places, static_cast<std::size_t>(here - now.begin()));
}

}  // namespace ziggurat::simulation
