// SPDX-License-Identifier: MIT
// The cameras of a controller: where they sit, their lenses, and what they detect.

#include <algorithm>
#include <array>

#include "scene/draft.h"

namespace ziggurat::scene {
namespace {

constexpr std::array<std::string_view, 3> detector_names{"led_detector", "directional_led_detector",
                                                         "tag_detector"};
constexpr std::array<MediumKind, 3> detector_media{MediumKind::led, MediumKind::directional_led,
                                                   MediumKind::tag};
constexpr std::array<Detector::Kind, 3> detector_kinds{
    Detector::Kind::led, Detector::Kind::directional_led, Detector::Kind::tag};

constexpr unsigned most_picture_pixels = 4096;  // along a side

std::optional<Detector> read_detector(Draft& draft, Element& element) {
  for (std::size_t i = 0; i < detector_names.size(); ++i) {
    if (element.name() != detector_names[i]) continue;
    const auto medium = read_medium(draft, element, detector_media[i]);
    const bool rays = element.optional("show_rays", boolean, false);
    element.done();
    if (!medium) return std::nullopt;
    return Detector{detector_kinds[i], *medium, rays, element.where()};
  }
  element.unknown_in("camera", detector_names);
  return std::nullopt;
}

Camera read_camera(Draft& draft, Element& element) {
  Camera camera;
  camera.where = element.where();
  camera.id = element.required("id", identifier);
  camera.anchor = element.required("anchor", identifier);
  camera.pose = {element.required("position", position),
                 element.required("orientation", orientation)};
  doubt_angles(element, "orientation");
  const auto reach = element.required("range", In{"m", positive_range}, {1.0, 1.0});
  camera.near = reach.first;
  camera.far = reach.second;
  camera.focal_length =
      element.required("focal_length", In{"px", positive_vector2}, math::Vector2::Ones());
  camera.principal_point = element.required("principal_point", In{"px", vector2});
  camera.resolution = element.required("resolution", In{"px", resolution}, {1, 1});
  camera.image = element.optional("image", boolean, false);
  if (camera.image && std::ranges::max(camera.resolution) > most_picture_pixels) {
    element.fault_at("resolution", fmt::format("is too large for image=\"true\"; write at most "
                                               "{0},{0}",
                                               most_picture_pixels));
  }
  for (Element& child : last_of_each_name(element)) {
    if (const auto detector = read_detector(draft, child)) camera.detectors.push_back(*detector);
  }
  element.done();
  return camera;
}

}  // namespace

std::vector<Camera> read_cameras(Draft& draft, Element& sensor, ControllerUse& use) {
  constexpr std::string_view known[] = {"camera"};
  std::vector<Camera> cameras;
  Ids ids;
  for (Element& element : sensor.children()) {
    if (element.name() != "camera") {
      element.unknown_in(sensor.name(), known);
      continue;
    }
    cameras.push_back(read_camera(draft, element));
    const std::string& id = cameras.back().id;
    use.anchors.push_back(
        {"camera " + in_quotes(id), cameras.back().anchor, element.where("anchor")});
    take_id(element, ids, id, "camera");
  }
  return cameras;
}

}  // namespace ziggurat::scene
