// SPDX-License-Identifier: MIT
// Any text is read as an entity that a supervisor adds to a running scene. The reader must not
// crash or hang, an entity without faults must be consistent, and the scene must not change.

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <variant>

#include "small_scene.h"

using namespace ziggurat::scene;

namespace {

constexpr std::size_t max_size = 8192;  // of the added text [bytes]

ReadResult read_small_scene(ReadOptions options) {
  static const std::string text = [] {
    std::string whole = before;
    whole.insert(whole.find("<framework>"), "<include file=\"models\"/>");
    whole +=
        "<box id=\"b\" size=\"1,1,1\" movable=\"true\" mass=\"1\"><body position=\"0,0,0\"/></box>";
    return whole + after;
  }();
  options.open = [](const std::filesystem::path& path, std::size_t) {
    std::string included = models;
    const std::string itself = "<include file=\"models\"/>";  // a cycle would be a fault
    included.erase(included.find(itself), itself.size());
    return std::variant<File, std::string>{File{path.string(), included}};
  };
  ReadResult result = read_text(text, "folder/fuzz.argos", options);
  if (!result.ok()) throw std::logic_error(to_string(result.problems.front()));
  return result;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ReadResult strict = read_small_scene({}),
                          lenient = read_small_scene({.lenient = true});
  const ReadResult& small = size % 2 == 1 ? lenient : strict;
  const std::size_t files = small.scene.files.size();
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto is_taken = [](const std::string& id) { return id == "b"; };
  const Addition addition = small.additions.read(text, small.scene, max_size, is_taken);
  bool fault = false;
  for (const Problem& problem : addition.problems) {
    require(!problem.text.empty() && !to_string(problem).empty());
    fault |= problem.severity == Problem::Severity::fault;
  }
  require(addition.ok() == !fault);
  require(small.scene.files.size() == files && small.scene.entities.size() == 1);
  if (fault) return 0;
  require(addition.size <= max_size);
  require(!addition.entity.id.empty() && !is_taken(addition.entity.id));
  check_entity(addition.entity, small.scene);
  return 0;
}
