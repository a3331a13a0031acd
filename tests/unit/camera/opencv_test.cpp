// SPDX-License-Identifier: MIT
// Our projection compared with OpenCV's, and poses of tags that OpenCV computes from our corners.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "camera/detectors.h"
#include "camera/projection.h"
#include "math/random.h"

namespace ziggurat::camera {
namespace {

using math::Vector2;
using math::Vector3;

math::Quaternion random_turn(math::RandomStream& random) {
  return math::Quaternion(random.gaussian(0, 1), random.gaussian(0, 1), random.gaussian(0, 1),
                          random.gaussian(0, 1))
      .normalized();
}

/// A camera and its pose.
struct Shot {
  world::CameraLayout camera;
  math::Pose pose;  // X_WC
};

Shot random_shot(math::RandomStream& random) {
  Shot shot;
  shot.camera.near = 0.01;
  shot.camera.far = 10;
  shot.camera.focal_length = {random.uniform(100, 2000), random.uniform(100, 2000)};
  shot.camera.principal_point = {random.uniform(0, 1280), random.uniform(0, 720)};
  shot.camera.resolution = {1280, 720};
  const double x = random.uniform(-5, 5), y = random.uniform(-5, 5), z = random.uniform(0, 2);
  shot.pose = {{x, y, z}, random_turn(random)};
  return shot;
}

cv::Mat intrinsics(const world::CameraLayout& camera) {
  return (cv::Mat_<double>(3, 3) << camera.focal_length.x(), 0, camera.principal_point.x(), 0,
          camera.focal_length.y(), camera.principal_point.y(), 0, 0, 1);
}

cv::Mat rotation_vector(const math::Quaternion& turn) {
  const Eigen::AngleAxisd angle_axis(turn);
  const Vector3 v = angle_axis.angle() * angle_axis.axis();
  return (cv::Mat_<double>(3, 1) << v.x(), v.y(), v.z());
}

cv::Mat column(const Vector3& v) { return (cv::Mat_<double>(3, 1) << v.x(), v.y(), v.z()); }

math::Pose pose_of(const cv::Mat& rotation, const cv::Mat& translation) {
  const Vector3 v(rotation.at<double>(0), rotation.at<double>(1), rotation.at<double>(2));
  const double angle = v.norm();
  const Vector3 axis = angle > 0 ? Vector3(v / angle) : Vector3::UnitX();
  return {Vector3(translation.at<double>(0), translation.at<double>(1), translation.at<double>(2)),
          math::Quaternion(Eigen::AngleAxisd(angle, axis))};
}

TEST(OpenCv, ProjectsToTheSamePixels) {
  math::RandomStream random(1, "projection");
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    const Shot shot = random_shot(random);
    const math::Pose from_world = math::inverse(shot.pose);
    std::vector<cv::Point3d> points;
    std::vector<Vector2> ours;
    for (int k = 0; k < 20; ++k) {
      const double z = random.uniform(0.02, 9);
      const Vector3 seen(random.uniform(-1, 1) * z, random.uniform(-1, 1) * z, z);
      const Vector3 point = shot.pose * seen;
      points.emplace_back(point.x(), point.y(), point.z());
      ours.push_back(project(shot.camera, from_world * point));
    }
    std::vector<cv::Point2d> theirs;
    cv::projectPoints(points, rotation_vector(from_world.orientation), column(from_world.position),
                      intrinsics(shot.camera), cv::noArray(), theirs);
    for (std::size_t k = 0; k < points.size(); ++k) {
      worst = std::max(worst, (ours[k] - Vector2(theirs[k].x, theirs[k].y)).norm());
    }
  }
  EXPECT_LT(worst, 1e-6);
  RecordProperty("worst_px", std::to_string(worst));
}

TEST(OpenCv, FindsTheTruePoseOfATagFromItsCorners) {
  math::RandomStream random(2, "tags");
  double worst_position = 0, worst_angle = 0;
  int views = 0;
  while (views < 200) {
    const Shot shot = random_shot(random);
    // Up to 1 m away, up to 60 degrees from facing the camera.
    const double z = random.uniform(0.1, 0.9);
    const math::Pose faced{{random.uniform(-0.3, 0.3) * z, random.uniform(-0.3, 0.3) * z, z},
                           math::Quaternion(0, 1, 0, 0)};
    const double turn = random.uniform(-M_PI, M_PI), tilt = random.uniform(0.1, M_PI / 3);
    const math::Quaternion turned(Eigen::AngleAxisd(turn, Vector3::UnitZ()));
    const math::Quaternion tilted(Eigen::AngleAxisd(tilt, Vector3::UnitX()));
    const double about = random.uniform(-M_PI, M_PI);
    const math::Quaternion rolled(Eigen::AngleAxisd(about, Vector3::UnitZ()));
    const math::Pose in_camera{faced.position, faced.orientation * turned * tilted * rolled};
    const double side = random.uniform(0.02, 0.06), half = side / 2;

    const math::Pose from_world = math::inverse(shot.pose);
    std::vector<cv::Point2d> pixels;
    for (const Vector3& corner : tag_corners(shot.pose * in_camera, side)) {
      const Vector2 pixel = project(shot.camera, from_world * corner);
      pixels.emplace_back(pixel.x(), pixel.y());
    }
    // IPPE_SQUARE expects (-,+), (+,+), (+,-), (-,-): our corners 2, 3, 4, 1.
    std::rotate(pixels.begin(), pixels.begin() + 1, pixels.end());
    const std::vector<cv::Point3d> square{
        {-half, half, 0}, {half, half, 0}, {half, -half, 0}, {-half, -half, 0}};
    cv::Mat rotation, translation;
    const cv::Mat lens = intrinsics(shot.camera);
    ASSERT_TRUE(cv::solvePnP(square, pixels, lens, cv::noArray(), rotation, translation, false,
                             cv::SOLVEPNP_IPPE_SQUARE));
    cv::solvePnPRefineLM(
        square, pixels, lens, cv::noArray(), rotation, translation,
        cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 100, 1e-14));
    const math::Pose found = pose_of(rotation, translation);
    worst_position = std::max(worst_position, (found.position - in_camera.position).norm());
    worst_angle = std::max(worst_angle, found.orientation.angularDistance(in_camera.orientation));
    ++views;
  }
  EXPECT_LT(worst_position, 1e-6);
  EXPECT_LT(worst_angle, 1e-4);
}

}  // namespace
}  // namespace ziggurat::camera
