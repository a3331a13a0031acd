// SPDX-License-Identifier: MIT
#include "magnetism/neighbours.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ziggurat::magnetism {
namespace {

/// The skin as a share of the cut-off: wider skins are rebuilt more rarely but list more pairs
/// out of range. Measured: flat between 0.1 and 0.2 (docs/magnetism.md).
constexpr double skin_share = 0.15;
/// Up to here comparing all is cheaper than filling a grid.
constexpr std::size_t comparison_limit = 48;
/// A list longer than this share of all pairs costs more than all pairs without a list.
constexpr double list_share_limit = 0.35;
/// A bound on memory: half a gigabyte of pairs.
constexpr double longest_list = 1 << 26;

double squared_distance(const Row& a, const Row& b) {
  const double x = a.x - b.x;
  const double y = a.y - b.y;
  const double z = a.z - b.z;
  return x * x + y * y + z * z;
}

/// Cells from the origin, whatever the coordinate; not-a-number counts as zero.
std::uint32_t cell(double offset, double inverse_edge) {
  const double cells = offset * inverse_edge;
  return cells >= 0 && cells < 4e15 ? static_cast<std::uint32_t>(static_cast<std::uint64_t>(cells))
                                    : 0;
}

}  // namespace

Neighbours::Neighbours(double cutoff)
    : reach_(cutoff * (1 + skin_share)), half_skin_(cutoff * skin_share / 2) {}

void Neighbours::update(const Dipoles& dipoles) {
  if (built_at_.size() == dipoles.count && !moved(dipoles)) return;
  rebuild(dipoles);
}

bool Neighbours::moved(const Dipoles& dipoles) const {
  const double limit = half_skin_ * half_skin_;
  bool all_near = true;
  for (std::size_t i = 0; i < dipoles.count; ++i) {
    all_near &= squared_distance(dipoles.positions[i], built_at_[i]) <= limit;
  }
  return !all_near;
}

void Neighbours::rebuild(const Dipoles& dipoles) {
  ++rebuilds_;
  built_at_.assign(dipoles.positions, dipoles.positions + dipoles.count);
  first_.clear();
  second_.clear();
  if (std::isinf(reach_)) {
    listed_ = false;
    return;
  }
  if (dipoles.count <= comparison_limit) {
    list_by_comparison(dipoles);
    listed_ = true;
  } else {
    fill_grid(dipoles);
    listed_ = list_by_grid(dipoles);
  }
  pad(dipoles.count);
}

void Neighbours::list_by_comparison(const Dipoles& dipoles) {
  for (std::size_t i = 0; i < dipoles.count; ++i) {
    for (std::size_t j = i + 1; j < dipoles.count; ++j) {
      if (dipoles.moments[i].w != dipoles.moments[j].w &&
          squared_distance(dipoles.positions[i], dipoles.positions[j]) <= reach_ * reach_) {
        first_.push_back(static_cast<std::uint32_t>(i));
        second_.push_back(static_cast<std::uint32_t>(j));
      }
    }
  }
}

void Neighbours::fill_grid(const Dipoles& dipoles) {
  const double infinity = std::numeric_limits<double>::infinity();
  Row low{infinity, infinity, infinity, 0};
  Row high{-infinity, -infinity, -infinity, 0};
  for (std::size_t i = 0; i < dipoles.count; ++i) {
    const Row& p = dipoles.positions[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z), 0};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z), 0};
  }
  const double inverse_edge = 1 / reach_;
  const double cells[] = {(high.x - low.x) * inverse_edge, (high.y - low.y) * inverse_edge,
                          (high.z - low.z) * inverse_edge};
  std::uint32_t bits[] = {2, 2, 2};
  std::size_t total = 64;
  for (bool grown = true; grown && total < dipoles.count;) {
    grown = false;
    for (int axis = 0; axis < 3 && total < dipoles.count; ++axis) {
      if ((1U << bits[axis]) > cells[axis]) continue;
      ++bits[axis];
      total *= 2;
      grown = true;
    }
  }
  grid_ = {low,     inverse_edge,     (1U << bits[0]) - 1, (1U << bits[1]) - 1, (1U << bits[2]) - 1,
           bits[0], bits[0] + bits[1]};

  places_.resize(dipoles.count);
  starts_.assign(total + 1, 0);
  for (std::size_t i = 0; i < dipoles.count; ++i) {
    const Row& p = dipoles.positions[i];
    places_[i] = (cell(p.x - low.x, inverse_edge) & grid_.mask_x) |
                 (cell(p.y - low.y, inverse_edge) & grid_.mask_y) << grid_.shift_y |
                 (cell(p.z - low.z, inverse_edge) & grid_.mask_z) << grid_.shift_z;
    ++starts_[places_[i]];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& start : starts_) start = sum += start;
  members_.resize(dipoles.count);
  member_rows_.resize(dipoles.count);
  for (std::size_t i = dipoles.count; i-- > 0;) {  // backwards: members stay in ascending order
    const std::uint32_t at = --starts_[places_[i]];
    members_[at] = static_cast<std::uint32_t>(i);
    member_rows_[at] = dipoles.positions[i];
    member_rows_[at].w = dipoles.moments[i].w;
  }
}

void Neighbours::gather_candidates(std::uint32_t place) {
  const std::uint32_t x = place & grid_.mask_x;
  const std::uint32_t y = place >> grid_.shift_y & grid_.mask_y;
  const std::uint32_t z = place >> grid_.shift_z;
  candidates_.clear();
  candidate_rows_.clear();
  for (std::uint32_t dz = 0; dz < 3; ++dz) {
    for (std::uint32_t dy = 0; dy < 3; ++dy) {
      for (std::uint32_t dx = 0; dx < 3; ++dx) {
        const std::uint32_t other = ((x + dx - 1) & grid_.mask_x) |
                                    ((y + dy - 1) & grid_.mask_y) << grid_.shift_y |
                                    ((z + dz - 1) & grid_.mask_z) << grid_.shift_z;
        const auto from = starts_[other];
        const auto to = starts_[other + 1];
        candidates_.insert(candidates_.end(), members_.begin() + from, members_.begin() + to);
        candidate_rows_.insert(candidate_rows_.end(), member_rows_.begin() + from,
                               member_rows_.begin() + to);
      }
    }
  }
}

bool Neighbours::list_by_grid(const Dipoles& dipoles) {
  const double limit = reach_ * reach_;
  const double all =
      0.5 * static_cast<double>(dipoles.count) * static_cast<double>(dipoles.count - 1);
  const auto most = static_cast<std::size_t>(std::min(list_share_limit * all, longest_list));
  found_.clear();
  found_from_.resize(dipoles.count);
  found_to_.resize(dipoles.count);
  for (std::uint32_t place = 0; place + 1 < starts_.size(); ++place) {
    if (starts_[place] == starts_[place + 1]) continue;
    gather_candidates(place);
    for (std::uint32_t at = starts_[place]; at < starts_[place + 1]; ++at) {
      const std::uint32_t i = members_[at];
      const Row row = member_rows_[at];
      const std::size_t from = found_.size();
      found_.resize(from + candidates_.size());
      std::uint32_t* end = found_.data() + from;
      for (std::size_t k = 0; k < candidates_.size(); ++k) {
        *end = candidates_[k];
        end += static_cast<int>(squared_distance(row, candidate_rows_[k]) <= limit) &
               static_cast<int>(candidates_[k] > i) &
               static_cast<int>(candidate_rows_[k].w != row.w);
      }
      found_.resize(static_cast<std::size_t>(end - found_.data()));
      std::sort(found_.begin() + static_cast<std::ptrdiff_t>(from), found_.end());
      found_from_[i] = static_cast<std::uint32_t>(from);
      found_to_[i] = static_cast<std::uint32_t>(found_.size());
      if (found_.size() > most) return false;
    }
  }
  for (std::uint32_t i = 0; i < dipoles.count; ++i) {
    first_.insert(first_.end(), found_to_[i] - found_from_[i], i);
    second_.insert(second_.end(), found_.begin() + found_from_[i], found_.begin() + found_to_[i]);
  }
  return true;
}

void Neighbours::pad(std::size_t count) {
  first_.resize((first_.size() + 3) / 4 * 4, static_cast<std::uint32_t>(count));
  second_.resize(first_.size(), static_cast<std::uint32_t>(count));
}

}  // namespace ziggurat::magnetism
