// SPDX-License-Identifier: MIT
// A snapshot as bytes: a line for people, what it belongs to, what was done to the world, its
// state, and a checksum.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "math/archive.h"
#include "math/hash.h"
#include "simulation/snapshot.h"

namespace ziggurat::simulation {
namespace {

constexpr std::string_view mark = "ziggurat snapshot, version 2\n";

std::uint64_t checksum(std::span<const std::byte> bytes) {
  math::Hash hash;
  hash.add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  return hash.digest();
}

void archive_edit(math::Archive& archive, WorldEdit& edit) {
  math::archive_choice(archive, "kind", edit.kind, WorldEdit::Kind::remove);
  archive("tick", edit.tick);
  archive("entity", edit.entity);
  archive("xml", edit.xml);
}

void archive_content(math::Archive& archive, Snapshot& snapshot) {
  archive("seed", snapshot.seed);
  archive.require(snapshot.seed != 0, "is 0");
  archive("tick", snapshot.tick);
  archive("hash", snapshot.hash);
  archive.list("acts", snapshot.history.edits,
               [&](WorldEdit& edit) { archive_edit(archive, edit); });
  archive.list("state", snapshot.state);
}

void check_order(const Snapshot& snapshot) {
  const auto spawned =
      std::ranges::count(snapshot.history.edits, WorldEdit::Kind::spawn, &WorldEdit::kind);
  if (static_cast<std::size_t>(spawned) > most_spawned) {
    throw SnapshotError(
        fmt::format("In the snapshot {} entities have been spawned; at most {} may be.", spawned,
                    most_spawned));
  }
  std::uint64_t tick = 0;
  for (const WorldEdit& edit : snapshot.history.edits) {
    if (edit.tick < tick || edit.tick > snapshot.tick) {
      throw SnapshotError("The snapshot's acts are not in the order of time.");
    }
    tick = edit.tick;
  }
}

}  // namespace

std::vector<std::byte> to_bytes(const Snapshot& snapshot, const Origin& origin) {
  for (const WorldEdit& edit : snapshot.history.edits) {
    if (edit.kind != WorldEdit::Kind::spawn || !edit.xml.empty()) continue;
    throw SnapshotError(
        fmt::format("'{}' was spawned without its element, so it can't be written to a file.",
                    edit.spawned->id));
  }
  std::vector<std::byte> bytes;
  auto archive = math::Archive::writer(bytes);
  std::string text(mark);
  archive.raw(text.data(), text.size());
  Origin from = origin;
  archive("scene_hash", from.scene_hash);
  archive("build", from.build);
  Snapshot copy = snapshot;
  archive_content(archive, copy);
  std::uint64_t sum = checksum(bytes);
  archive.raw(&sum, sizeof sum);
  return bytes;
}

Snapshot from_bytes(std::span<const std::byte> bytes, const Origin& origin,
                    const std::function<scene::Entity(const std::string& xml)>& read) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with(mark)) {
    throw SnapshotError(text.starts_with("ziggurat snapshot")
                            ? "The file is a snapshot of another version of this format."
                            : "The file is no snapshot.");
  }
  std::uint64_t sum = 0;
  if (bytes.size() < mark.size() + sizeof sum) throw SnapshotError("The snapshot is cut off.");
  const std::size_t content = bytes.size() - sizeof sum;
  std::memcpy(&sum, bytes.data() + content, sizeof sum);
  if (sum != checksum(bytes.first(content))) {
    throw SnapshotError("The snapshot is damaged: its checksum is wrong.");
  }
  Snapshot snapshot;
  Origin from;
  try {
    auto archive = math::Archive::reader(bytes.first(content).subspan(mark.size()));
    archive("scene_hash", from.scene_hash);
    archive("build", from.build);
    if (!origin.scene_hash.empty() && from.scene_hash != origin.scene_hash) {
      throw SnapshotError(
          fmt::format("The snapshot is of another scene: its hash is {}, this one's {}.",
                      from.scene_hash, origin.scene_hash));
    }
    if (!origin.build.empty() && from.build != origin.build) {
      throw SnapshotError(fmt::format("The snapshot was made by another build: {}; this is {}.",
                                      from.build, origin.build));
    }
    archive_content(archive, snapshot);
  } catch (const math::ArchiveError& error) {
    throw SnapshotError(std::string("The snapshot can't be read: ") + error.what());
  }
  check_order(snapshot);
  for (WorldEdit& edit : snapshot.history.edits) {
    if (edit.kind != WorldEdit::Kind::spawn) continue;
    edit.spawned = std::make_shared<const scene::Entity>(read(edit.xml));
  }
  return snapshot;
}

}  // namespace ziggurat::simulation
