// SPDX-License-Identifier: MIT
#include "render/shadow_map.h"

#include <algorithm>
#include <cmath>

namespace ziggurat::render {
namespace {

constexpr double slope_bias = 1.5;  // [texels]: a surface does not shade itself
constexpr int reach = 3;            // of a lookup [texels]

/// The part of a line y of a convex figure, as the texels whose centres are in it.
struct Chord {
  double left = 1e30, right = -1e30;

  void add_edge(const ShadowMap::Corner& a, const ShadowMap::Corner& b, double y) {
    const ShadowMap::Corner& low = a.y < b.y ? a : b;
    const ShadowMap::Corner& high = a.y < b.y ? b : a;
    if (!(low.y <= y && y < high.y)) return;
    const double x = low.x + (y - low.y) * ((high.x - low.x) / (high.y - low.y));
    left = std::min(left, x);
    right = std::max(right, x);
  }
};

/// The first texel whose centre is at or behind a place, within the map.
int texel_from(double place) {
  return static_cast<int>(std::clamp(std::ceil(place - 0.5), 0.0, double{shadow_size}));
}

}  // namespace

void ShadowMap::begin() {
  texels_.resize(std::size_t{side} * side);
  nearest_.assign(std::size_t{blocks} * blocks, 1.0f);
  is_open_.assign(std::size_t{blocks} * blocks, 0);
}

/// Blocks of something that is drawn there [blocks, inclusive]. Lookups in them may read those
/// around them.
void ShadowMap::open(unsigned left, unsigned right, unsigned low, unsigned high, float depth) {
  const auto before = [](unsigned i) { return i == 0 ? 0 : i - 1; };
  const auto after = [](unsigned i) { return std::min(i + 1, blocks - 1); };
  for (unsigned y = before(low); y <= after(high); ++y) {
    for (unsigned x = before(left); x <= after(right); ++x) {
      const std::size_t i = x + std::size_t{y} * blocks;
      if (!is_open_[i]) {
        is_open_[i] = 1;
        float* texel = &texels_[(std::size_t{y} * side + x) * block];
        for (unsigned row = 0; row < block; ++row, texel += side) std::fill_n(texel, block, 1.0f);
      }
      if (x >= left && x <= right && y >= low && y <= high) {
        nearest_[i] = std::min(nearest_[i], depth);
      }
    }
  }
}

void ShadowMap::draw(const std::array<Corner, 3>& corners) {
  const auto& [p, q, r] = corners;
  const double area = (q.x - p.x) * (r.y - p.y) - (r.x - p.x) * (q.y - p.y);
  if (!(area > 0)) return;
  const auto [left, right] = std::minmax({p.x, q.x, r.x});
  const auto [low, high] = std::minmax({p.y, q.y, r.y});
  const int begin_x = texel_from(left), end_x = texel_from(right);
  const int begin_y = texel_from(low), end_y = texel_from(high);
  if (begin_x == end_x || begin_y == end_y) return;
  // The depth is linear over the triangle.
  const double across =
      ((q.depth - p.depth) * (r.y - p.y) - (r.depth - p.depth) * (q.y - p.y)) / area;
  const double down =
      ((r.depth - p.depth) * (q.x - p.x) - (q.depth - p.depth) * (r.x - p.x)) / area;
  const double bias = slope_bias * std::max(std::abs(across), std::abs(down));
  const double least = std::min({p.depth, q.depth, r.depth}) + bias;
  open(place(begin_x - reach) / block, place(end_x - 1 + reach) / block,
       place(begin_y - reach) / block, place(end_y - 1 + reach) / block,
       static_cast<float>(least) - 1e-6f);
  for (int y = begin_y; y < end_y; ++y) {
    Chord chord;
    chord.add_edge(p, q, y + 0.5);
    chord.add_edge(q, r, y + 0.5);
    chord.add_edge(r, p, y + 0.5);
    if (!(chord.left < chord.right)) continue;
    const int begin = texel_from(chord.left), end = texel_from(chord.right);
    const auto depth =
        static_cast<float>(p.depth + bias + (begin + 0.5 - p.x) * across + (y + 0.5 - p.y) * down);
    const auto step = static_cast<float>(across);
    float* texel = &texels_[place(y) * std::size_t{side} + place(begin)];
    for (int i = 0; i < end - begin; ++i) {
      const float here = depth + step * static_cast<float>(i);
      texel[i] = here < texel[i] ? here : texel[i];
    }
  }
}

}  // namespace ziggurat::render
