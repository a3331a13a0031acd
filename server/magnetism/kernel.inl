// SPDX-License-Identifier: MIT
// The loops of Kernel; lanes.inl tells which files include this.

#include "magnetism/lanes.inl"

ZIGGURAT_INLINE Mask none_masked() { return Mask{-1, -1, -1, -1}; }

template <bool tapered>
static void add_pairs(const Dipoles& dipoles, const Pairs& pairs, const Range& range,
                      const Sums& sums) {
  const Row* p = dipoles.positions;
  const Row* m = dipoles.moments;
  for (std::size_t k = 0; k < pairs.count; k += 4) {
    const std::uint32_t* i = pairs.first + k;
    const std::uint32_t* j = pairs.second + k;
    FourPairs four = four_pairs<tapered>(columns(p[i[0]], p[i[1]], p[i[2]], p[i[3]]),
                                         columns(m[i[0]], m[i[1]], m[i[2]], m[i[3]]),
                                         columns(p[j[0]], p[j[1]], p[j[2]], p[j[3]]),
                                         columns(m[j[0]], m[j[1]], m[j[2]], m[j[3]]), range,
                                         none_masked());
    Columns& f = four.force;
    Columns& b1 = four.first_field;
    Columns& b2 = four.second_field;
    transpose(f.x, f.y, f.z, f.w);
    transpose(b1.x, b1.y, b1.z, b1.w);
    transpose(b2.x, b2.y, b2.z, b2.w);
    const auto add = [&](std::size_t lane, const Lanes& force, const Lanes& first,
                         const Lanes& second) __attribute__((always_inline)) {
      Row& force1 = sums.forces[i[lane]];
      Row& field1 = sums.fields[i[lane]];
      store(force1, load(force1) + force);
      store(field1, load(field1) + first);
      Row& force2 = sums.forces[j[lane]];
      Row& field2 = sums.fields[j[lane]];
      store(force2, load(force2) - force);
      store(field2, load(field2) + second);
    };
    add(0, f.x, b1.x, b2.x);
    add(1, f.y, b1.y, b2.y);
    add(2, f.z, b1.z, b2.z);
    add(3, f.w, b1.w, b2.w);
  }
}

ZIGGURAT_INLINE void accumulate(Columns& sum, const Columns& term) {
  sum.x += term.x;
  sum.y += term.y;
  sum.z += term.z;
}

/// The four rows from begin on: their pairs among themselves, then with all later rows.
template <bool tapered, bool open>
ZIGGURAT_INLINE void add_block(const Dipoles& dipoles, std::size_t begin, const Range& range,
                               const Sums& sums) {
  const Row* p = dipoles.positions;
  const Row* m = dipoles.moments;
  const Columns p1 = columns(p[begin], p[begin + 1], p[begin + 2], p[begin + 3]);
  const Columns m1 = columns(m[begin], m[begin + 1], m[begin + 2], m[begin + 3]);
  Row* f = sums.forces + begin;
  Row* b = sums.fields + begin;
  Columns force = columns(f[0], f[1], f[2], f[3]);
  Columns field = columns(b[0], b[1], b[2], b[3]);
  const Mask lane{0, 1, 2, 3};
  for (long long k = 0; k < 4; ++k) {
    const Columns m2 = same(m[begin + k]);
    const Mask allowed = (lane != k) & (m1.w != m2.w);
    const FourPairs four = four_pairs<tapered>(p1, m1, same(p[begin + k]), m2, range, allowed);
    accumulate(force, four.force);
    accumulate(field, four.first_field);
  }
  // Roots and divisions first, for a few rows together: waiting for them would otherwise hold up
  // the next row's arithmetic.
  constexpr std::size_t ahead = 16;
  Lanes inverses[ahead];
  for (std::size_t from = begin + 4; from < dipoles.count; from += ahead) {
    const std::size_t rows = from + ahead < dipoles.count ? ahead : dipoles.count - from;
    for (std::size_t k = 0; k < rows; ++k) {
      inverses[k] = inverse_distance<open>(p1, same(p[from + k]), range);
    }
    for (std::size_t k = 0; k < rows; ++k) {
      const std::size_t j = from + k;
      const Columns m2 = same(m[j]);
      FourPairs four = four_pairs<tapered, open>(p1, m1, same(p[j]), m2, inverses[k], range,
                                                 m1.w != m2.w);
      accumulate(force, four.force);
      accumulate(field, four.first_field);
      Columns& back = four.force;
      Columns& second = four.second_field;
      transpose(back.x, back.y, back.z, back.w);
      transpose(second.x, second.y, second.z, second.w);
      Row& force2 = sums.forces[j];
      Row& field2 = sums.fields[j];
      store(force2, load(force2) - back.x - back.y - back.z - back.w);
      store(field2, load(field2) + second.x + second.y + second.z + second.w);
    }
  }
  transpose(force.x, force.y, force.z, force.w);
  transpose(field.x, field.y, field.z, field.w);
  const Lanes forces[] = {force.x, force.y, force.z, force.w};
  const Lanes fields[] = {field.x, field.y, field.z, field.w};
  for (std::size_t k = 0; k < 4; ++k) {
    store(f[k], forces[k]);
    store(b[k], fields[k]);
  }
}

template <bool tapered, bool open>
static void add_all_pairs(const Dipoles& dipoles, const Range& range, const Sums& sums) {
  for (std::size_t begin = 0; begin < dipoles.count; begin += 4) {
    add_block<tapered, open>(dipoles, begin, range, sums);
  }
}

static void pairs(const Dipoles& dipoles, const Pairs& list, const Range& range,
                  const Sums& sums) {
  if (range.taper_start < range.maximum) {
    add_pairs<true>(dipoles, list, range, sums);
  } else {
    add_pairs<false>(dipoles, list, range, sums);
  }
}

static bool is_open(const Dipoles& dipoles, const Range& range) {
  if (range.maximum <= 1.7976931348623157e308) return false;
  for (std::size_t i = 0; i < dipoles.count; ++i) {
    if (dipoles.positions[i].w != 0) return false;
  }
  return true;
}

static void all_pairs(const Dipoles& dipoles, const Range& range, const Sums& sums) {
  if (range.taper_start < range.maximum) {
    add_all_pairs<true, false>(dipoles, range, sums);
  } else if (is_open(dipoles, range)) {
    add_all_pairs<false, true>(dipoles, range, sums);
  } else {
    add_all_pairs<false, false>(dipoles, range, sums);
  }
}

template <bool tapered>
ZIGGURAT_INLINE Row sum_field_at(const Dipoles& dipoles, std::size_t dipole,
                                 const std::uint32_t* partners, std::size_t count,
                                 const Range& range) {
  const Row* p = dipoles.positions;
  const Row* m = dipoles.moments;
  const Columns p1 = same(p[dipole]);
  const Columns m1 = same(m[dipole]);
  Lanes sum = all(0);
  for (std::size_t k = 0; k < count; k += 4) {
    const std::uint32_t* j = partners + k;
    const Columns m2 = columns(m[j[0]], m[j[1]], m[j[2]], m[j[3]]);
    Columns field = four_pairs<tapered>(p1, m1, columns(p[j[0]], p[j[1]], p[j[2]], p[j[3]]), m2,
                                        range, m1.w != m2.w)
                        .first_field;
    transpose(field.x, field.y, field.z, field.w);
    sum = sum + field.x + field.y + field.z + field.w;
  }
  Row result;
  store(result, sum);
  return result;
}

static Row field_at(const Dipoles& dipoles, std::size_t dipole, const std::uint32_t* partners,
                    std::size_t count, const Range& range) {
  return range.taper_start < range.maximum
             ? sum_field_at<true>(dipoles, dipole, partners, count, range)
             : sum_field_at<false>(dipoles, dipole, partners, count, range);
}

/// The sums over the lanes of each of four registers, always in the same order.
ZIGGURAT_INLINE Lanes totals(Columns lanes) {
  transpose(lanes.x, lanes.y, lanes.z, lanes.w);
  return (lanes.x + lanes.y) + (lanes.z + lanes.w);
}

static PointResult points(const Row& moment, const Row& source, const Row& separation,
                          const Points& set) {
  constexpr double K = 1e-7;
  const Columns m1 = same(moment);
  const Columns m2 = same(source);
  const Lanes moments = dot(m1, m2);
  const Lanes zero = all(0);
  Lanes cubes = zero, first = zero, second = zero;
  Columns radial = columns(zero, zero, zero);
  Columns along = radial;
  const double* axes = set.axes;
  for (std::size_t k = 0; k < set.count; k += 4) {
    const Lanes x = load(set.x + k);
    const Lanes y = load(set.y + k);
    const Lanes z = load(set.z + k);
    const Columns r = columns(separation.x - (axes[0] * x + axes[1] * y + axes[2] * z),
                              separation.y - (axes[3] * x + axes[4] * y + axes[5] * z),
                              separation.z - (axes[6] * x + axes[7] * y + axes[8] * z));
    const Lanes inverse = 1 / square_root(larger(dot(r, r), all(1e-24)));
    const Lanes square = inverse * inverse;
    const Lanes cube = load(set.weight + k) * (square * inverse);
    const Lanes fifth = cube * square;
    const Lanes dot1 = dot(m1, r);
    const Lanes dot2 = dot(m2, r);
    const Lanes a = dot2 * fifth;
    const Lanes c = moments * fifth - 5 * (a * dot1 * square);
    cubes += cube;
    first += a;
    second += dot1 * fifth;
    accumulate(radial, columns(c * r.x, c * r.y, c * r.z));
    accumulate(along, columns(a * r.x, a * r.y, a * r.z));
  }
  const Lanes coefficients = totals({first, second, cubes, zero});
  const Lanes a = all(coefficients[0]);
  const Lanes b = all(coefficients[1]);
  const Lanes c = all(coefficients[2]);
  PointResult result;
  store(result.force, (3 * K) * ((a * load(moment) + b * load(source)) + totals(radial)));
  store(result.field, K * (3 * totals(along) - c * load(source)));
  return result;
}
