// SPDX-License-Identifier: MIT
// Eight floats side by side. Included by one translation unit per instruction set, inside an
// anonymous namespace; nothing here may call a library function. Bits do not depend on the
// instruction set: each lane does the same add, multiply, divide and square root.

typedef float Lanes __attribute__((vector_size(32)));
typedef float UnalignedLanes __attribute__((vector_size(32), aligned(4), may_alias));
typedef int Mask __attribute__((vector_size(32)));
typedef int UnalignedMask __attribute__((vector_size(32), aligned(4), may_alias));
typedef float Four __attribute__((vector_size(16)));
typedef float UnalignedFour __attribute__((vector_size(16), aligned(4), may_alias));
typedef int FourMask __attribute__((vector_size(16)));

constexpr int lane_count = 8;

#define ZIGGURAT_INLINE [[gnu::always_inline]] static inline

ZIGGURAT_INLINE Lanes all(float value) {
  return Lanes{value, value, value, value, value, value, value, value};
}

ZIGGURAT_INLINE Lanes load(const float* values) {
  return *reinterpret_cast<const UnalignedLanes*>(values);
}
ZIGGURAT_INLINE void store(float* values, const Lanes& lanes) {
  *reinterpret_cast<UnalignedLanes*>(values) = lanes;
}
ZIGGURAT_INLINE Mask load(const std::uint32_t* values) {
  return *reinterpret_cast<const UnalignedMask*>(values);
}
ZIGGURAT_INLINE void store(std::uint32_t* values, const Mask& lanes) {
  *reinterpret_cast<UnalignedMask*>(values) = lanes;
}

ZIGGURAT_INLINE Mask chosen(const Mask& mask, const Mask& a, const Mask& b) {
  return (mask & a) | (~mask & b);
}
ZIGGURAT_INLINE Lanes chosen(const Mask& mask, const Lanes& a, const Lanes& b) {
  return reinterpret_cast<Lanes>(
      chosen(mask, reinterpret_cast<Mask>(a), reinterpret_cast<Mask>(b)));
}

/// b where a is not greater, in particular where either is not a number.
ZIGGURAT_INLINE Lanes larger(const Lanes& a, const Lanes& b) {
#if defined(ZIGGURAT_AVX2)
  return _mm256_max_ps(a, b);
#else
  return chosen(a > b, a, b);
#endif
}
ZIGGURAT_INLINE Lanes smaller(const Lanes& a, const Lanes& b) {
#if defined(ZIGGURAT_AVX2)
  return _mm256_min_ps(a, b);
#else
  return chosen(a < b, a, b);
#endif
}
ZIGGURAT_INLINE Lanes clamped(const Lanes& a) { return smaller(larger(a, all(0)), all(1)); }

ZIGGURAT_INLINE Lanes magnitude(const Lanes& a) {
  return reinterpret_cast<Lanes>(reinterpret_cast<Mask>(a) & 0x7fffffff);
}

ZIGGURAT_INLINE Lanes square_root(const Lanes& a) {
#if defined(ZIGGURAT_AVX2)
  return _mm256_sqrt_ps(a);
#elif defined(__SSE2__)
  const __m128 low = _mm_sqrt_ps(__m128{a[0], a[1], a[2], a[3]});
  const __m128 high = _mm_sqrt_ps(__m128{a[4], a[5], a[6], a[7]});
  return Lanes{low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]};
#else
  Lanes root;
  for (int i = 0; i < lane_count; ++i) root[i] = __builtin_sqrtf(a[i]);
  return root;
#endif
}

ZIGGURAT_INLINE Lanes whole_below(const Lanes& a) {
  const Lanes cut = __builtin_convertvector(__builtin_convertvector(a, Mask), Lanes);
  return cut - reinterpret_cast<Lanes>((cut > a) & reinterpret_cast<Mask>(all(1)));
}

/// e to the power -t, for t >= 0, to within 3e-7.
ZIGGURAT_INLINE Lanes decayed(const Lanes& t) {
  const Lanes power = larger(t * -1.44269504f, all(-126));
  const Lanes whole = whole_below(power), f = power - whole;
  const Lanes part =
      1.0f + f * (0.69314718f +
                  f * (0.24022651f + f * (0.05550411f + f * (0.00961813f + f * 0.00133336f))));
  const Mask scale = (__builtin_convertvector(whole, Mask) + 127) << 23;
  return part * reinterpret_cast<Lanes>(scale);
}

ZIGGURAT_INLINE bool any(const Mask& mask) {
#if defined(ZIGGURAT_AVX2)
  return _mm256_movemask_ps(reinterpret_cast<Lanes>(mask)) != 0;
#else
  int found = 0;
  for (int i = 0; i < lane_count; ++i) found |= mask[i];
  return found != 0;
#endif
}

struct Point {
  Lanes x, y, z;
};

ZIGGURAT_INLINE Point same(const Float3& point) {
  return {all(point[0]), all(point[1]), all(point[2])};
}
ZIGGURAT_INLINE Point operator+(const Point& a, const Point& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
ZIGGURAT_INLINE Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
ZIGGURAT_INLINE Point operator*(const Point& a, const Lanes& b) {
  return {a.x * b, a.y * b, a.z * b};
}
ZIGGURAT_INLINE Lanes dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
ZIGGURAT_INLINE Lanes dot(const Float3& a, const Point& b) {
  return a[0] * b.x + a[1] * b.y + a[2] * b.z;
}
ZIGGURAT_INLINE Point unit(const Point& a) { return a * (1.0f / square_root(dot(a, a))); }
