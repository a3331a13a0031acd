// SPDX-License-Identifier: MIT
// Four doubles side by side, and the pair formulas on them. Included by one translation unit per
// instruction set, inside an anonymous namespace; nothing here may call a library function.

typedef double Lanes __attribute__((vector_size(32)));
typedef double UnalignedLanes __attribute__((vector_size(32), aligned(8), may_alias));
typedef double AliasedLanes __attribute__((vector_size(32), may_alias));
typedef long long Mask __attribute__((vector_size(32)));

#define ZIGGURAT_INLINE [[gnu::always_inline]] static inline

ZIGGURAT_INLINE Lanes all(double value) { return Lanes{value, value, value, value}; }

ZIGGURAT_INLINE Lanes load(const Row& row) {
  return *reinterpret_cast<const AliasedLanes*>(&row);
}

ZIGGURAT_INLINE Lanes load(const double* values) {
  return *reinterpret_cast<const UnalignedLanes*>(values);
}

ZIGGURAT_INLINE void store(Row& row, const Lanes& lanes) {
  *reinterpret_cast<AliasedLanes*>(&row) = lanes;
}

/// value where the mask is set, else +0.
ZIGGURAT_INLINE Lanes keep(const Mask& mask, const Lanes& value) {
  return reinterpret_cast<Lanes>(mask & reinterpret_cast<Mask>(value));
}

/// b where a is not greater, in particular where either is not a number.
ZIGGURAT_INLINE Lanes larger(const Lanes& a, const Lanes& b) {
#if defined(ZIGGURAT_AVX2)
  return _mm256_max_pd(a, b);
#else
  const Mask mask = a > b;
  return reinterpret_cast<Lanes>((mask & reinterpret_cast<Mask>(a)) |
                                 (~mask & reinterpret_cast<Mask>(b)));
#endif
}

ZIGGURAT_INLINE Lanes square_root(const Lanes& a) {
#if defined(ZIGGURAT_AVX2)
  return _mm256_sqrt_pd(a);
#elif defined(__SSE2__)
  const __m128d low = _mm_sqrt_pd(__m128d{a[0], a[1]});
  const __m128d high = _mm_sqrt_pd(__m128d{a[2], a[3]});
  return Lanes{low[0], low[1], high[0], high[1]};
#else
  return Lanes{__builtin_sqrt(a[0]), __builtin_sqrt(a[1]), __builtin_sqrt(a[2]),
               __builtin_sqrt(a[3])};
#endif
}

/// Rows to columns and back.
ZIGGURAT_INLINE void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Lanes ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Lanes cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Lanes cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

/// Coordinates of four rows, one register each.
struct Columns {
  Lanes x, y, z, w;
};

ZIGGURAT_INLINE Columns columns(const Lanes& x, const Lanes& y, const Lanes& z) {
  return {x, y, z, all(0)};
}

ZIGGURAT_INLINE Columns columns(const Row& a, const Row& b, const Row& c, const Row& d) {
  Columns result{load(a), load(b), load(c), load(d)};
  transpose(result.x, result.y, result.z, result.w);
  return result;
}

ZIGGURAT_INLINE Columns same(const Row& row) {
  return {all(row.x), all(row.y), all(row.z), all(row.w)};
}

ZIGGURAT_INLINE Lanes dot(const Columns& a, const Columns& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Force on the first four dipoles, and field at the second four.
struct FourPairs {
  Columns force;         ///< on the first
  Columns first_field;   ///< of the second at the first
  Columns second_field;  ///< of the first at the second
};

/// Factor on the energy and its derivative by distance, see Range.
struct Fade {
  Lanes factor, slope;
};

ZIGGURAT_INLINE Fade fade(const Lanes& distance, const Range& range) {
  const double width = range.maximum - range.taper_start;
  Lanes u = (distance - range.taper_start) * (1 / width);
  u = larger(u, all(0));
  u = -larger(-u, all(-1));
  const Lanes rest = 1 - u;
  return {1 - u * u * u * (10 - 15 * u + 6 * (u * u)), (-30 / width) * (u * u) * (rest * rest)};
}

/// One over the distance, or over the least distance that counts.
/// @tparam open  no cores and no maximum: the same bits with less to do
template <bool open>
ZIGGURAT_INLINE Lanes inverse_distance(const Columns& p1, const Columns& p2, const Range& range) {
  const Columns r = columns(p1.x - p2.x, p1.y - p2.y, p1.z - p2.z);
  const Lanes closest = open ? all(range.minimum) : larger(p1.w + p2.w, all(range.minimum));
  return 1 / square_root(larger(dot(r, r), closest * closest));
}

/// @param inverse  inverse_distance() of the same
/// @param allowed  lanes that count, before the range is looked at
template <bool tapered, bool open = false>
ZIGGURAT_INLINE FourPairs four_pairs(const Columns& p1, const Columns& m1, const Columns& p2,
                                     const Columns& m2, const Lanes& inverse, const Range& range,
                                     const Mask& allowed) {
  constexpr double K = 1e-7;
  const Columns r = columns(p1.x - p2.x, p1.y - p2.y, p1.z - p2.z);
  Mask mask = allowed;
  if constexpr (!open) mask &= dot(r, r) <= range.maximum * range.maximum;
  const Lanes square = inverse * inverse;
  const Lanes along1 = dot(m1, r);
  const Lanes along2 = dot(m2, r);
  const Lanes moments = dot(m1, m2);
  const Lanes product = (along1 * along2) * square;
  const Lanes whole = keep(mask, (K * inverse) * square);
  const Fade f = tapered ? fade(1 / inverse, range) : Fade{all(1), all(0)};
  const Lanes cube = tapered ? whole * f.factor : whole;
  const Lanes fifth = (3 * cube) * square;
  Lanes radial = fifth * (moments - 5 * product);
  // The gradient of the fading: - f' U n with U = K / d^3 (m1.m2 - 3 (m1.n)(m2.n)).
  if constexpr (tapered) radial -= (f.slope * inverse) * (whole * (moments - 3 * product));
  const Lanes toward1 = fifth * along2;
  const Lanes toward2 = fifth * along1;
  return {columns((toward1 * m1.x + toward2 * m2.x) + radial * r.x,
                  (toward1 * m1.y + toward2 * m2.y) + radial * r.y,
                  (toward1 * m1.z + toward2 * m2.z) + radial * r.z),
          columns(toward1 * r.x - cube * m2.x, toward1 * r.y - cube * m2.y,
                  toward1 * r.z - cube * m2.z),
          columns(toward2 * r.x - cube * m1.x, toward2 * r.y - cube * m1.y,
                  toward2 * r.z - cube * m1.z)};
}

template <bool tapered>
ZIGGURAT_INLINE FourPairs four_pairs(const Columns& p1, const Columns& m1, const Columns& p2,
                                     const Columns& m2, const Range& range, const Mask& allowed) {
  const Lanes inverse = inverse_distance<false>(p1, p2, range);
  return four_pairs<tapered>(p1, m1, p2, m2, inverse, range, allowed);
}
