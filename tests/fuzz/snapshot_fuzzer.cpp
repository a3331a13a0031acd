// SPDX-License-Identifier: MIT
// Snapshots are files of anyone. Whatever is changed in one: the world is restored to some state,
// which can be stepped, or the snapshot is refused and the world stays as it is. Checksums and
// hashes are those of the changed bytes: who changes a file can compute them.

#include <optional>
#include <stdexcept>

#include "math/hash.h"
#include "simulation/snapshot.h"
#include "small_world.h"

namespace {

using namespace ziggurat;
using fuzz::require;
using simulation::Snapshot;

struct World {
  World() : read(fuzz::read_small_world()) { begin(); }
  void begin() { world.emplace(read.scene, simulation::Options{3, {}}); }
  scene::Entity entity(const std::string& xml) const {
    scene::Addition addition =
        read.additions.read(xml, read.scene, 1 << 16, [](const std::string&) { return false; });
    if (!addition.ok()) throw scene::SceneError(std::move(addition.problems));
    return std::move(addition.entity);
  }
  scene::ReadResult read;
  std::optional<simulation::Simulation> world;
};

/// With an entity that came, one that went, and contacts.
Snapshot with_a_past(World& own) {
  for (int i = 0; i < 5; ++i) own.world->step();
  own.world->spawn(own.read.scene, own.entity(fuzz::small_box), fuzz::small_box);
  own.world->remove(1);
  for (int i = 0; i < 5; ++i) own.world->step();
  return own.world->snapshot();
}

void step(World& own) {
  try {
    own.world->step();
    own.world->step();
  } catch (const std::runtime_error&) {  // it is not finite any more
    own.begin();
  }
}

/// Past the hash of the state.
void restore_state(World& own, const Snapshot& valid, std::span<const std::uint8_t> edits) {
  Snapshot snapshot = valid;
  snapshot.state = fuzz::edited(valid.state, edits);
  own.world->restore(own.read.scene, valid);  // the same entities: what follows is copied unchecked
  try {
    own.world->restore(own.read.scene, snapshot);
  } catch (const std::runtime_error&) {
    return own.begin();
  }
  own.world->snapshot();
  step(own);
}

void restore_file(World& own, const std::vector<std::byte>& valid,
                  std::span<const std::uint8_t> edits) {
  const std::uint64_t before = own.world->hash();
  std::vector<std::byte> bytes = fuzz::edited(valid, edits);
  math::Hash hash;
  hash.add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  const std::uint64_t sum = hash.digest();
  const auto* end = reinterpret_cast<const std::byte*>(&sum);
  bytes.insert(bytes.end(), end, end + sizeof sum);
  try {
    own.world->restore(
        own.read.scene,
        simulation::from_bytes(bytes, {}, [&](const std::string& xml) { return own.entity(xml); }));
  } catch (const std::runtime_error&) {
    require(own.world->hash() == before);
    return;
  }
  step(own);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static World world;
  static const Snapshot valid = with_a_past(world);
  static const std::vector<std::byte> file = [] {
    std::vector<std::byte> bytes = simulation::to_bytes(valid, {"scene", "build"});
    bytes.resize(bytes.size() - sizeof(std::uint64_t));  // the checksum
    return bytes;
  }();
  if (size == 0) return 0;
  const std::span edits(data + 1, size - 1);
  data[0] % 2 == 0 ? restore_state(world, valid, edits) : restore_file(world, file, edits);
  return 0;
}
