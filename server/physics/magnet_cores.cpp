// SPDX-License-Identifier: MIT
#include <algorithm>

#include "physics/collision/shape.h"
#include "physics/magnet_source.h"

namespace ziggurat::physics {
namespace {

using math::Vector3;

/// A magnet, what moves it, and the ball about it.
struct Ball {
  std::size_t part = 0;
  bool turns = false;
  Vector3 centre{0, 0, 0};  // in the part [m]
  double radius = 0;        // [m]
};

Ball ball_of(const Body& body, const scene::Entity& entity, const scene::Magnet& magnet) {
  const bool on_origin = magnet.anchor.link == scene::Anchor::origin;
  std::size_t number =
      on_origin ? body.reference_link : static_cast<std::size_t>(magnet.anchor.link);
  const LinkBody& anchor = body.links[number];
  math::Pose frame = anchor.frame_in_part();
  if (on_origin) frame = frame * body.origin_from_reference;
  Ball ball;
  ball.part = anchor.part;
  ball.turns = turns_freely(anchor, magnet);
  ball.centre = frame * magnet.offset;
  if (anchor.carrier != LinkBody::carries_itself) number = static_cast<std::size_t>(anchor.carrier);
  if (!entity.links[number].collides) return ball;
  const Vector3 in_shape = math::inverse(body.links[number].in_part) * ball.centre;
  ball.radius = std::max(0.0, depth(entity.links[number].geometry, in_shape));
  return ball;
}

}  // namespace

void set_magnet_cores(Body& body, const scene::Entity& entity) {
  constexpr double share = 0.9;
  std::vector<Ball> balls;
  for (const Magnet& magnet : body.magnets) balls.push_back(ball_of(body, entity, magnet.scene));
  const bool several =
      std::ranges::any_of(balls, [&](const Ball& ball) { return ball.part != balls[0].part; });
  const bool any_turns = std::ranges::any_of(balls, &Ball::turns);
  for (std::size_t i = 0; i < balls.size() && !several; ++i) {
    double radius = balls[i].radius;
    for (std::size_t j = 0; j < balls.size() && any_turns;
         ++j) {  // those that act on each other stay apart
      if (j == i || !(balls[i].turns || balls[j].turns)) continue;
      radius = std::min(radius, (balls[i].centre - balls[j].centre).norm() / 2);
    }
    body.magnets[i].core = share * radius;
  }
}

}  // namespace ziggurat::physics
