// SPDX-License-Identifier: MIT
#include "recording/replay/scene.h"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <utility>

#include "math/hash.h"
#include "recording/replay/recording_file.h"
#include "scene/reader.h"
#include "ziggurat/v1/run.pb.h"

namespace ziggurat::replay {
namespace {

std::optional<scene::Clock> clock_of(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (name == "nominal") return scene::Clock::nominal;
  if (name == "beta50") return scene::Clock::beta50;
  throw RecordingError(fmt::format(
      "the recording's clock is '{}', which this version does not know; replay it with the version "
      "that made it",
      name));
}

/// As of the files on disk when the run began: 16 hexadecimal digits.
std::string hash_of(const scene::Scene& scene, const scene::Variation& variation,
                    const EmbeddedFiles& files) {
  math::Hash hash;
  for (const std::string& name : scene.files) {
    const std::string* bytes = files.find(name);
    hash.add(bytes ? std::string_view(*bytes) : std::string_view());
  }
  if (const std::string text = to_text(variation); !text.empty()) hash.add(text);
  return math::to_hex(hash.digest());
}

}  // namespace

scene::OpenScene read_scene(const v1::RunStart& run, const EmbeddedFiles& files,
                            const scene::Variation& more) {
  if (run.scene().find('\0') != std::string::npos) {
    throw RecordingError("the name of the recording's scene has a zero byte");
  }
  if (run.seed() == 0) throw RecordingError("the recording's seed is 0, which no run has");
  scene::ReadOptions options;
  options.lenient = run.lenient();
  for (const auto& each : run.settings()) {
    options.variation.settings.push_back({each.name(), each.value()});
  }
  for (const auto& each : run.parameters()) {
    options.variation.parameters.emplace_back(each.name(), each.value());
  }
  const scene::Variation recorded = options.variation;
  for (const auto& each : more.settings) options.variation.settings.push_back(each);
  for (const auto& each : more.parameters) {
    std::erase_if(options.variation.parameters,
                  [&](const auto& other) { return other.first == each.first; });
    options.variation.parameters.push_back(each);
  }
  options.clock = clock_of(run.clock());
  options.open = files.opener();
  scene::ReadResult read = scene::read_file(run.scene(), options);
  if (!read.ok()) throw scene::SceneError(std::move(read.problems));
  const std::string hash = hash_of(read.scene, recorded, files);
  if (!run.scene_hash().empty() && hash != run.scene_hash()) {
    throw RecordingError(
        fmt::format("the hash of the embedded scene is {}, that of the recorded "
                    "run is {}: the recording was changed",
                    hash, run.scene_hash()));
  }
  return {std::move(read.scene), std::move(read.additions)};
}

void check_core(const v1::RunStart& run, const scene::Scene& scene) {
  if (run.core() != 0 || !scene.physics.had_second_core) return;
  throw RecordingError(
      fmt::format("the run was computed with solver=\"sweeps\", which this version does not have, "
                  "so that it can't be repeated; "
                  "show its poses (ziggurat replay --from-poses), or repeat it with the version "
                  "that recorded it{}",
                  run.build().version().empty() ? "" : ": " + run.build().version()));
}

std::string scene_hash(const scene::Scene& scene, const EmbeddedFiles& files) {
  return hash_of(scene, scene.variation, files);
}

simulation::Snapshot read_snapshot(const RecordingFile& file, const std::string& name,
                                   const scene::Scene& scene, const scene::Additions& additions) {
  const auto bytes = file.snapshot(name);
  if (!bytes) {
    throw RecordingError(fmt::format(
        "{}: the snapshot '{}' that it needs is missing: the run was ended before it was written",
        file.path(), name));
  }
  return simulation::from_bytes(std::as_bytes(std::span(*bytes)), {},
                                reader_of_spawned(additions, scene, file.files().opener()));
}

}  // namespace ziggurat::replay
