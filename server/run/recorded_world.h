#pragma once
// The world that a recording begins with.

#include "recording/replay/recording_file.h"
#include "recording/replay/replay.h"
#include "supervision/world.h"

namespace ziggurat::run {

/// Puts a new world of the recording's scene and seed where the recording begins: into a snapshot,
/// if it is one of a fork. @throws replay::RecordingError, simulation::SnapshotError
void begin_as_recorded(const replay::RecordingFile& file, supervision::World& world);

/// Reads the snapshots that the recording has embedded. Both must outlive it.
replay::Replay::OpenSnapshot embedded_snapshots(const replay::RecordingFile& file,
                                                const supervision::World& world);

}  // namespace ziggurat::run
