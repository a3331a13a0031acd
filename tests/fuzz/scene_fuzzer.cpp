// SPDX-License-Identifier: MIT
// Any text is read as a scene. The reader must not crash or hang, and a scene without faults must
// be consistent, so that later code need not check it again. A text that does not begin like a
// whole scene becomes the content of an arena.

#include <cstdint>
#include <string>

#include "small_scene.h"

using namespace ziggurat::scene;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ReadOptions options;
  options.lenient = size % 2 == 1;
  options.max_size = 8192;
  std::string text(reinterpret_cast<const char*>(data), size);
  const bool is_whole = text.starts_with("<argos-configuration") || text.starts_with("<?");
  if (!is_whole) text = before + text + after;
  options.open = [&text](const std::filesystem::path& path, std::size_t) {
    return open_from_memory(path, text);
  };
  const ReadResult result = read_text(text, "folder/fuzz.argos", options);
  bool fault = false;
  for (const Problem& problem : result.problems) {
    require(!problem.text.empty() && !to_string(problem).empty());
    fault |= problem.severity == Problem::Severity::fault;
  }
  require(result.ok() == !fault);
  require(text.size() <= options.max_size || fault);
  if (!result.ok()) return 0;
  require(result.scene.experiment.ticks_per_second >= 1 && result.scene.physics.iterations >= 1);
  for (const Entity& entity : result.scene.entities) check_entity(entity, result.scene);
  for (const Distribution& group : result.scene.distributions) {
    check_entity(group.entity, result.scene);
  }
  return 0;
}
