#pragma once
// A recording as a world that is run again: its begin, its snapshots, its ticks.

#include <cstdint>

#include "recording/replay/recording_file.h"
#include "recording/replay/replay.h"
#include "supervision/world.h"

namespace ziggurat::rerun {

/// Puts a new world of the recording's scene and seed where the recording begins: into a snapshot,
/// if it is one of a fork. @throws replay::RecordingError, simulation::SnapshotError
void begin_as_recorded(const replay::RecordingFile& file, supervision::World& world);

/// Reads the snapshots that the recording has embedded. Both must outlive it.
replay::Replay::OpenSnapshot embedded_snapshots(const replay::RecordingFile& file,
                                                const supervision::World& world);

/// Checks --until of commands that repeat a recording, and reads it as far as that tick. One that
/// is damaged before it is told later.
/// @throws text::UsageError if it has no state with this tick
void check_until(const replay::RecordingFile& file, std::uint64_t until);

}  // namespace ziggurat::rerun
