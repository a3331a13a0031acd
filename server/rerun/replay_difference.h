// SPDX-License-Identifier: MIT
#pragma once
// Explains where a repeated run first differs from its recording, and why it may.

#include <string>
#include <vector>

#include "recording/replay/recording_file.h"
#include "recording/replay/replay.h"
#include "supervision/world.h"

namespace ziggurat::rerun {

/// A sentence with tick, entity, field and both values.
/// @param states  has read the inputs of the present state last
std::string explain_difference(const replay::RecordingFile& file, const replay::States& states,
                               const replay::Replay& replay, supervision::World& world);

/// Sentences on what differs between the program that recorded and this one.
std::vector<std::string> likely_causes(const v1::RunStart& recorded);

}  // namespace ziggurat::rerun
