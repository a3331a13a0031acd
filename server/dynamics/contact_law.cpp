#include "dynamics/contact_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ziggurat::dynamics {
namespace {

constexpr double give = 1e-8;  // of held speeds, over the mobility

/// Friction's discs: first row, dimension, bound over the normal impulse.
struct Disc {
  int first, size;
  double ratio;
};

/// @return  how many
int discs(const Block& block, Disc* out) {
  if (block.law != Block::Law::contact || block.rows == 1) return 0;
  out[0] = {1, 2, block.friction};
  if (block.rows == 3) return 1;
  out[1] = {3, 1, block.spinning};
  out[2] = {4, 2, block.rolling};
  return 3;
}

void hold(const Block& block, int row, Linear& out) {
  const double stiffness = 1 / (give * block.mobility[row]);
  out.slope[row * block.rows + row] = stiffness;
  out.constant[row] = block.impulse[row] + stiffness * block.seek[row];
}

void hold_normal(const Block& block, Linear& out) {
  if (block.yield == 0) return hold(block, 0, out);
  out.slope[0] = 1 / block.yield;
  out.constant[0] = block.seek[0] / block.yield;
}

/// Friction within a disc: sticks, or slides with its whole bound against the slip.
/// @param normal  part of y, > 0
void linearise(const Block& block, const Disc& disc, const double* y, Linear& out) {
  const double bound = disc.ratio * y[0];
  double square = 0;
  for (int r = 0; r < disc.size; ++r) square += y[disc.first + r] * y[disc.first + r];
  if (square <= bound * bound) {
    for (int r = 0; r < disc.size; ++r) hold(block, disc.first + r, out);
    return;
  }
  const double length = std::sqrt(square);
  double direction[2] = {};
  for (int r = 0; r < disc.size; ++r) direction[r] = y[disc.first + r] / length;
  const int rows = block.rows;
  for (int r = 0; r < disc.size; ++r) {
    const int row = disc.first + r;
    out.constant[row] = disc.ratio * direction[r] * out.constant[0];
    out.slope[row * rows] = disc.ratio * direction[r] * out.slope[0];
  }
  if (disc.size < 2 || bound <= 0) return;
  // Across the slip the direction turns with the speed.
  const double mobility = block.mobility[disc.first];
  const double across = std::min(bound / (length - bound), 1 / give) / mobility;
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 2; ++c) {
      const double projection = (r == c ? 1 : 0) - direction[r] * direction[c];
      const int row = disc.first + r, column = disc.first + c;
      out.slope[row * rows + column] += across * projection;
      out.constant[row] += across * projection * block.seek[column];
    }
  }
}

void project(const Block& block, double* y) {
  if (block.law == Block::Law::bounded) {
    y[0] = std::clamp(y[0], block.lower, block.upper);
    return;
  }
  y[0] = block.law == Block::Law::contact ? std::max(0.0, y[0]) : 0;
  Disc all[3];
  const int count = discs(block, all);
  for (int d = 0; d < count; ++d) {
    const Disc& disc = all[d];
    const double bound = disc.ratio * y[0];
    double square = 0;
    for (int r = 0; r < disc.size; ++r) square += y[disc.first + r] * y[disc.first + r];
    if (square <= bound * bound) continue;
    const double factor = bound / std::sqrt(square);
    for (int r = 0; r < disc.size; ++r) y[disc.first + r] *= factor;
  }
}

int active_rows(const Block& block) {
  return block.law == Block::Law::contact ? block.rows : block.law == Block::Law::bounded ? 1 : 0;
}

/// A contact with friction that does not resist rolling and spinning: most are so.
bool is_plain(const Block& block) { return block.rows == 3 && block.law == Block::Law::contact; }

/// y of one row, see contact_law.h.
double pressed(const Block& block, const double* u, int row) {
  const double yields = row == 0 ? block.yield * block.impulse[0] : 0;
  return block.impulse[row] - (u[row] + yields - block.seek[row]) / block.mobility[row];
}

void linearise_plain(const Block& block, const double* u, Linear& out) {
  const double normal = pressed(block, u, 0);
  out.zero = normal <= 0;
  if (out.zero) return;
  const double y[2] = {pressed(block, u, 1), pressed(block, u, 2)};
  const double* seek = block.seek.data() + 1;
  auto& slope = out.slope;
  auto& constant = out.constant;
  slope[1] = slope[2] = 0;
  hold_normal(block, out);
  const double bound = block.friction * normal, square = y[0] * y[0] + y[1] * y[1];
  if (square <= bound * bound) {
    const double held = 1 / (give * block.mobility[1]);  // both tangents have the same mobility
    slope[3] = slope[5] = slope[6] = slope[7] = 0;
    slope[4] = slope[8] = held;
    constant[1] = block.impulse[1] + held * seek[0];
    constant[2] = block.impulse[2] + held * seek[1];
    return;
  }
  const double length = std::sqrt(square);
  const double direction[2] = {y[0] / length, y[1] / length};
  // Across the slip the direction turns with the speed.
  const double across =
      bound > 0 ? std::min(bound / (length - bound), 1 / give) / block.mobility[1] : 0;
  for (int r = 0; r < 2; ++r) {
    const double share = block.friction * direction[r];
    const double along = across * ((r == 0) - direction[r] * direction[0]);
    const double beside = across * ((r == 1) - direction[r] * direction[1]);
    slope[3 + 3 * r] = share * slope[0];
    slope[4 + 3 * r] = along;
    slope[5 + 3 * r] = beside;
    constant[1 + r] = share * constant[0] + along * seek[0] + beside * seek[1];
  }
}

/// Of a contact without normal force: all its impulses should be none.
double miss_of_loose(const Block& block) {
  double worst = 0;
  for (int r = 0; r < block.rows; ++r) {
    worst = std::max(worst, std::abs(block.impulse[r]) * block.mobility[r]);
  }
  return worst;
}

/// What the impulses of a plain contact are more than the law's.
/// @param normal  part of y, > 0
std::array<double, 3> wrong_of_plain(const Block& block, const double* u, double normal) {
  double y[2] = {pressed(block, u, 1), pressed(block, u, 2)};
  const double bound = block.friction * normal, square = y[0] * y[0] + y[1] * y[1];
  if (square > bound * bound) {
    const double factor = bound / std::sqrt(square);
    y[0] *= factor, y[1] *= factor;
  }
  const auto& g = block.impulse;
  return {g[0] - normal, g[1] - y[0], g[2] - y[1]};
}

double miss_of_plain(const Block& block, const double* u, double normal) {
  const auto wrong = wrong_of_plain(block, u, normal);
  const auto& m = block.mobility;
  return std::max({std::abs(wrong[0]) * m[0], std::abs(wrong[1]) * m[1], std::abs(wrong[2]) * m[2]});
}

}  // namespace

void linearise(const Block& block, const double* u, Linear& out) {
  if (is_plain(block)) return linearise_plain(block, u, out);
  const int rows = block.rows;
  out.zero = true;
  if (block.law == Block::Law::off) return;
  double y[Block::most_rows] = {};
  for (int r = 0; r < active_rows(block); ++r) y[r] = pressed(block, u, r);
  if (block.law == Block::Law::contact && y[0] <= 0) return;
  out.zero = false;
  std::fill_n(out.constant.begin(), rows, 0.0);
  std::fill_n(out.slope.begin(), rows * rows, 0.0);
  if (block.law == Block::Law::bounded) {
    if (y[0] <= block.lower || y[0] >= block.upper) {
      out.constant[0] = y[0] <= block.lower ? block.lower : block.upper;
      out.zero = out.constant[0] == 0;
    } else {
      hold(block, 0, out);
    }
    return;
  }
  hold_normal(block, out);
  Disc all[3];
  const int count = discs(block, all);
  for (int d = 0; d < count; ++d) linearise(block, all[d], y, out);
}

void soften(const Block& block, const double* u, double softness, bool anchors, double* impulse, Linear* out) {
  const int rows = block.rows, active = active_rows(block);
  std::fill_n(impulse, rows, 0.0);
  if (out) {
    out->zero = true;
    std::fill_n(out->slope.begin(), rows * rows, 0.0);
  }
  if (active == 0) return;
  double y[Block::most_rows];
  for (int r = 0; r < active; ++r) {
    y[r] = (anchors ? block.anchor[r] : 0) - (u[r] - block.seek[r]) / (softness * block.mobility[r]);
  }
  const auto give_way = [&](int row, int column, double share) {
    if (!out) return;
    out->zero = false;
    out->slope[row * rows + column] = share / (softness * block.mobility[row]);
  };
  const double lower = block.law == Block::Law::bounded ? block.lower : 0;
  const double upper =
      block.law == Block::Law::bounded ? block.upper : std::numeric_limits<double>::infinity();
  const double give_of_normal = softness * block.mobility[0];
  const double share = give_of_normal / (anchors ? give_of_normal + block.yield : std::max(give_of_normal, block.yield));
  y[0] *= share;
  impulse[0] = std::clamp(y[0], lower, upper);
  if (y[0] > lower && y[0] < upper) give_way(0, 0, share);
  Disc all[3];
  const int count = discs(block, all);
  for (int d = 0; d < count; ++d) {
    const auto [first, size, ratio] = all[d];
    const double bound = ratio * impulse[0];
    double square = 0;
    for (int r = first; r < first + size; ++r) square += y[r] * y[r];
    if (bound == 0 && square > 0) continue;
    const double length = std::sqrt(square);
    const bool slides = length > bound;
    const double share = slides ? bound / length : 1;
    for (int r = first; r < first + size; ++r) {
      impulse[r] = share * y[r];
      if (slides && out) {
        out->slope[r * rows] = ratio * y[r] / length * out->slope[0];
      }
      for (int c = first; c < first + size && share > 0; ++c) {
        double entry = r == c ? share : 0;
        if (slides) entry -= share * y[r] * y[c] / square;
        give_way(r, c, entry);
      }
    }
  }
}

double miss(const Block& block, const double* u) {
  if (block.law == Block::Law::contact) {
    const double normal = pressed(block, u, 0);
    if (normal <= 0) return miss_of_loose(block);
    if (is_plain(block)) return miss_of_plain(block, u, normal);
  }
  const int rows = active_rows(block);
  double y[Block::most_rows];
  for (int r = 0; r < rows; ++r) y[r] = pressed(block, u, r);
  project(block, y);
  double worst = 0;
  for (int r = 0; r < rows; ++r) {
    worst = std::max(worst, std::abs(block.impulse[r] - y[r]) * block.mobility[r]);
  }
  return worst;
}

double wrong_energy(const Block& block, const double* u) {
  double sum = 0;
  if (is_plain(block)) {
    const double normal = pressed(block, u, 0);
    const std::array<double, 3> wrong = normal > 0 ? wrong_of_plain(block, u, normal)
                                                   : std::array{block.impulse[0], block.impulse[1], block.impulse[2]};
    for (int r = 0; r < 3; ++r) sum += wrong[r] * wrong[r] * block.mobility[r];
    return sum;
  }
  const int rows = active_rows(block);
  double y[Block::most_rows];
  for (int r = 0; r < rows; ++r) y[r] = pressed(block, u, r);
  project(block, y);
  for (int r = 0; r < rows; ++r) {
    sum += (block.impulse[r] - y[r]) * (block.impulse[r] - y[r]) * block.mobility[r];
  }
  return sum;
}

void clip(const Block& block, double* impulse) { project(block, impulse); }

}  // namespace ziggurat::dynamics
