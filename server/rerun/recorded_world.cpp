#include "rerun/recorded_world.h"

#include <fmt/format.h>

#include <algorithm>

#include "recording/mcap/source.h"
#include "recording/replay/recording_error.h"
#include "recording/replay/scene.h"
#include "text/numbers.h"

namespace ziggurat::rerun {

void begin_as_recorded(const replay::RecordingFile& file, supervision::World& world) {
  replay::check_core(file.run(), world.scene);
  const std::string& name = file.run().snapshot();
  if (name.empty()) return;
  try {
    world.restore(replay::read_snapshot(file, name, world.scene, world.additions));
  } catch (const simulation::SnapshotError& error) {
    throw replay::RecordingError(
        fmt::format("{}: the state that it begins with: {}", file.path(), error.what()));
  }
}

replay::Replay::OpenSnapshot embedded_snapshots(const replay::RecordingFile& file,
                                                const supervision::World& world) {
  return [&file, &world](const std::string& name) {
    return replay::read_snapshot(file, name, world.scene, world.additions);
  };
}

void check_until(const replay::RecordingFile& file, std::uint64_t until) {
  std::uint64_t least = 0, greatest = 0;
  try {
    replay::States states(file);
    const v1::Inputs* next = states.next();
    if (next == nullptr) return;
    for (least = greatest = next->tick(); next != nullptr; next = states.next()) {
      if (next->tick() == until) return;
      least = std::min<std::uint64_t>(least, next->tick());
      greatest = std::max<std::uint64_t>(greatest, next->tick());
    }
  } catch (const replay::RecordingError&) {
    return;
  } catch (const mcap::Damaged&) {
    return;
  }
  throw text::UsageError(fmt::format(
      "--until is {}, and {} has the ticks {} to {}; write one of them, or leave it out", until,
      file.path(), least, greatest));
}

}  // namespace ziggurat::rerun
