// Any text is read as a scene: never a crash or a hang, and what is called free of faults holds
// together, so that nobody behind the reader has to check it again.

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <variant>

#include "scene/reader.h"

namespace {

using namespace ziggurat::scene;

void require(bool condition) {
  if (!condition) std::abort();
}

void check_entity(const Entity& entity, const Scene& scene) {
  require(!entity.links.empty());
  require(entity.reference_link < entity.links.size());
  for (const Link& link : entity.links) {
    require(link.offset.position.allFinite() && link.offset.orientation.coeffs().allFinite());
  }
  for (const Joint& joint : entity.joints) {
    require(joint.parent < entity.links.size() && joint.child < entity.links.size());
    require(joint.axis.allFinite());
    require(!joint.limit || joint.limit->lower <= joint.limit->upper);
  }
  require(!entity.controller || *entity.controller < scene.controllers.size());
  require(!entity.model || *entity.model < scene.models.size());
}

constexpr const char* models =
    "<m><include file=\"models\"/><controllers><c id=\"c2\"><actuators/><sensors>"
    "<range_and_bearing implementation=\"medium\" medium=\"rab\"/></sensors></c></controllers>"
    "<models><prototype id=\"m\"><links ref=\"a\"><link id=\"a\" geometry=\"sphere\" radius=\"1\" "
    "mass=\"1\"/></links><devices><leds medium=\"leds\"><led anchor=\"a\" offset=\"0,0,0\" "
    "color=\"red\"/></leds></devices><controller config=\"c\"/></prototype></models></m>";

/// What a scene includes comes from memory, never from this machine: a file of models, or for
/// names with an s the scene itself under another identity.
std::variant<File, std::string> open_from_memory(const std::filesystem::path& path,
                                                 const std::string& scene) {
  const std::string name = path.filename().string();
  if (name.starts_with("models")) return File{name, models};
  if (name.starts_with("s")) return File{path.string(), scene};
  return "does not exist";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ReadOptions options;
  options.lenient = size % 2 == 1;
  options.max_size = 8192;
  const std::string text(reinterpret_cast<const char*>(data), size);
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
  require(size <= options.max_size || fault);
  if (!result.ok()) return 0;
  require(result.scene.experiment.ticks_per_second >= 1 && result.scene.physics.iterations >= 1);
  for (const Entity& entity : result.scene.entities) check_entity(entity, result.scene);
  for (const Distribution& group : result.scene.distributions) {
    check_entity(group.entity, result.scene);
  }
  return 0;
}
