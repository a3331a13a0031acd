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

// What is no whole scene is what stands in the arena of this one.
constexpr const char* before =
    "<argos-configuration><framework><experiment ticks_per_second=\"10\"/></framework><controllers>"
    "<lua_controller id=\"c\"><actuators><joints implementation=\"default\"><joint id=\"j\" "
    "mode=\"velocity\" max_impulse=\"1\"/></joints></actuators><sensors><cameras "
    "implementation=\"default\"><camera id=\"k\" anchor=\"a\" range=\"0.1:2\" position=\"0,0,0\" "
    "orientation=\"0,0,0\" resolution=\"64,48\" focal_length=\"80,80\" principle_point=\"32,24\">"
    "<tag_detector medium=\"tags\"/></camera></cameras></sensors><params script=\"a.lua\"/>"
    "</lua_controller></controllers><physics_engines><dynamics3d "
    "id=\"d\"/></physics_engines><media>"
    "<led id=\"leds\"/><directional_led id=\"dirleds\"/><tag id=\"tags\"/><radio id=\"radio\"/>"
    "<range_and_bearing id=\"rab\"/></media><arena size=\"9,9,9\">";
constexpr const char* after = "</arena></argos-configuration>";

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
