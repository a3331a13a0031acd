// SPDX-License-Identifier: MIT
// The simulated tag detector compared with a real one, libapriltag, on the rendered picture.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "../long_runs.h"
#include "../render/detector.h"
#include "../simulation/small_scene.h"
#include "camera/detectors.h"
#include "devices/camera.h"
#include "physics/collision/ray.h"
#include "simulation/layout.h"

namespace ziggurat::camera {
namespace {

using math::Pose;
using math::Quaternion;
using math::Vector2;
using math::Vector3;

constexpr double side = 0.08;                // of tags [m]
constexpr double grazing = 65 * M_PI / 180;  // from a tag's normal [rad]

/// A block of 12 cm with a tag on three of its faces.
std::string block(int number, const std::string& position, const std::string& orientation) {
  const auto tag = [&](int which, const std::string& pose) {
    return "<tag anchor=\"b\" observable_angle=\"80\" side_length=\"0.08\" payload=\"" +
           std::to_string(17 * number + which) + "\" " + pose + "/>";
  };
  return "<prototype id=\"block" + std::to_string(number) +
         R"(" movable="false"><body position=")" + position + "\" orientation=\"" + orientation +
         R"("/><links ref="b"><link id="b" geometry="box" size=".12,.12,.12" mass="1"/></links>)" +
         R"(<devices><tags medium="tags">)" +
         tag(0, R"(position="0,0,0.12" orientation="30,0,0")") +
         tag(1, R"(position="0.0605,0,0.06" orientation="0,90,0")") +  // 0.5 mm above the face
         tag(2, R"(position="0,-0.06,0.06" orientation="0,0,90")") +
         "</tags></devices></prototype>";
}

/// A scene of blocks and a post; the camera can be placed anywhere.
struct BlockScene {
  BlockScene() {
    simulation::testing::SmallScene text;
    text.sensors =
        R"(<cameras implementation="default"><camera id="eye" anchor="origin" position="0,0,0")"
        R"( orientation="0,0,0" range="0.02:5" focal_length="360,360" principal_point="203.5,148.25")"
        R"( resolution="400,300" image="true"><tag_detector medium="tags"/></camera></cameras>)";
    text.engine = "<floor/>";
    text.arena =
        block(1, "0,0,0", "0,0,0") + block(2, "0.35,0.1,0", "30,0,0") +
        block(3, "-0.3,0.1,0", "-30,0,0") + block(4, "-0.1,0.45,0", "10,0,0") +
        R"(<box id="post" size="0.02,0.02,0.3" movable="false"><body position="0.2,-0.25,0"/></box>)" +
        simulation::testing::robot("r", "0,0,-5", "");
    scene = text.read();
    layout = simulation::make_layout(scene, scene.entities, 0.01);
    for (const auto& entity : scene.entities) {
      state.origins.push_back(entity.pose);
      state.links.push_back({entity.pose});
    }
    for (const auto& tag : layout.tags) state.tag_payloads.push_back(tag.payload);
  }

  scene::Scene scene;
  world::Layout layout;
  world::State state;
};

/// The simulated and the real detector. The robot's body is below the floor, outside of all views.
class BothDetectors {
 public:
  explicit BothDetectors(BlockScene& stage)
      : stage_(stage),
        rays_(stage.scene.physics),
        index_(stage.layout),
        renderer_(stage.scene, stage.scene.entities, stage.layout) {
    for (const auto& entity : stage.scene.entities) rays_.add(entity);
    rays_.update(stage.state);
  }

  void place_camera(const Pose& pose) { stage_.state.origins.back() = pose; }

  bool clear(const Vector3& eye, const Vector3& target) const {
    std::size_t left = 1;
    return devices::OcclusionTest{rays_, 0, nullptr, nullptr, {}, left}.clear(eye, target);
  }

  std::map<int, std::array<Vector2, 4>> simulated() {
    index_.build(stage_.state);
    std::vector<std::size_t> candidates;
    std::vector<world::TagReading> readings;
    detect_tags(
        View(stage_.layout, stage_.state, index_, 0),
        [this](const Vector3& eye, const Vector3& target) { return clear(eye, target); },
        candidates, readings);
    std::map<int, std::array<Vector2, 4>> found;
    for (const auto& reading : readings) {
      found[std::stoi(stage_.state.tag_payloads[reading.tag])] = reading.corners;
    }
    return found;
  }

  std::map<int, std::array<Vector2, 4>> real() {
    const auto& lens = stage_.layout.cameras[0];
    renderer_.draw(stage_.state, devices::view_of(lens, world::pose_of(stage_.state, lens.mount)),
                   picture_);
    std::map<int, std::array<Vector2, 4>> found;
    for (const auto& detection : detector_.detect(picture_)) {
      found[detection.id] = detection.corners;
    }
    return found;
  }

  /// Whether the whole tag with its white margin is in the image and not hidden.
  bool is_fully_visible(int id) {
    const Pose tag = pose_of(id);
    const View view(stage_.layout, stage_.state, index_, 0);
    constexpr int steps = 10;
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; j <= steps; ++j) {
        const double h = side * 10 / 8;
        const Vector3 point = tag * Vector3(h * i / steps - h / 2, h * j / steps - h / 2, 0);
        if (!view.find(point) || !clear(view.pose.position, point)) return false;
      }
    }
    return true;
  }

  /// Angle between a tag's normal and the direction to the camera [rad].
  double obliqueness(int id) {
    const Pose tag = pose_of(id);
    const Vector3 to_camera = stage_.state.origins.back().position - tag.position;
    return std::acos(to_camera.normalized().dot(tag.orientation * Vector3::UnitZ()));
  }

 private:
  Pose pose_of(int id) {
    const auto& payloads = stage_.state.tag_payloads;
    const auto tag = std::ranges::find(payloads, std::to_string(id)) - payloads.begin();
    return world::pose_of(stage_.state, stage_.layout.tags[static_cast<std::size_t>(tag)].mount);
  }

  BlockScene& stage_;
  physics::Rays rays_;
  media::DevicesIndex index_;
  render::Renderer renderer_;
  render::Picture picture_;
  render::testing::Detector detector_;
};

/// A random pose around the blocks that looks at them, with a random roll.
Pose random_camera(std::mt19937_64& random) {
  // Distributions of std differ between implementations; this gives the same values with all.
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  const double distance = between(0.35, 0.9), azimuth = between(-1.6, 0.1),
               elevation = between(0.3, 1.2);
  // One statement each: compilers evaluate arguments in different orders.
  const double z = between(0.0, 0.12), y = between(-0.05, 0.45), x = between(-0.3, 0.35);
  const Vector3 target(x, y, z);
  const Vector3 eye =
      target + distance * Vector3(std::cos(azimuth) * std::cos(elevation),
                                  std::sin(azimuth) * std::cos(elevation), std::sin(elevation));
  Pose pose = render::look_at(eye, target);
  pose.orientation =
      pose.orientation * Quaternion(Eigen::AngleAxisd(between(-M_PI, M_PI), Vector3::UnitZ()));
  return pose;
}

struct Agreement {
  int both = 0, grazing_views = 0, partly_hidden = 0;
  double worst = 0, sum = 0;  // greatest distance of a corner, over tags that agree [px]
};

void compare(int view, BothDetectors& detectors, Agreement& result) {
  const auto simulated = detectors.simulated();
  const auto real = detectors.real();
  const auto disagree = [&](int id, const std::string& what) {
    const double oblique = detectors.obliqueness(id);
    const bool hidden = !detectors.is_fully_visible(id);
    result.grazing_views += oblique > grazing && !hidden;
    result.partly_hidden += hidden;
    const auto line = fmt::format("view {:3}, tag {:3}: {} ({:.0f} degrees off its normal{})", view,
                                  id, what, oblique * 180 / M_PI, hidden ? ", partly hidden" : "");
    std::puts(line.c_str());
    EXPECT_TRUE(hidden || oblique > grazing) << line;
  };
  for (const auto& [id, corners] : simulated) {
    const auto other = real.find(id);
    if (other == real.end()) continue;
    double worst = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      worst = std::max(worst, (corners[c] - other->second[c]).norm());
    }
    if (worst > 0.7) {
      disagree(id, fmt::format("corners are {:.2f} px apart", worst));
      continue;
    }
    ++result.both;
    result.worst = std::max(result.worst, worst);
    result.sum += worst;
  }
  for (const auto& [id, corners] : simulated) {
    if (!real.contains(id)) disagree(id, "only the simulated detector sees it");
  }
  for (const auto& [id, corners] : real) {
    if (!simulated.contains(id)) disagree(id, "only the real detector sees it");
  }
}

TEST(SimulatedTagDetector, AgreesWithARealOne) {
  BlockScene stage;
  BothDetectors detectors(stage);
  std::mt19937_64 random(20);
  Agreement result;
  const int views = long_runs::takes_all() ? 200 : 50;
  for (int view = 0; view < views; ++view) {
    detectors.place_camera(random_camera(random));
    compare(view, detectors, result);
  }
  std::printf(
      "%d views: %d tags agree, distance of the worst corner %.3f px on average, %.3f px at "
      "most; others: %d in grazing views, %d partly hidden\n",
      views, result.both, result.sum / result.both, result.worst, result.grazing_views,
      result.partly_hidden);
  EXPECT_GT(result.both, 2 * views);
  EXPECT_LT(result.grazing_views + result.partly_hidden, result.both / 5);
}

}  // namespace
}  // namespace ziggurat::camera
