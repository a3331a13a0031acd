// SPDX-License-Identifier: MIT
#include "magnetism/elementary.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace ziggurat::magnetism {

namespace {

/// 1/3, 1/5, 1/7 ...: the series of the arc tangent and of the logarithm.
template <int count>
constexpr std::array<double, count> odd_reciprocals() {
  std::array<double, count> result{};
  for (int k = 0; k < count; ++k) result[k] = 1.0 / (2 * k + 3);
  return result;
}

/// Sum over k of c[k] x^k, by halves: a chain of multiplications is slow.
template <int count>
double polynomial(const std::array<double, count>& c, double x) {
  const double square = x * x;
  double even = c[count - 2];
  double odd = c[count - 1];
#pragma GCC unroll 16
  for (int k = count - 4; k >= 0; k -= 2) {
    even = even * square + c[k];
    odd = odd * square + c[k + 1];
  }
  return even + odd * x;
}

}  // namespace

double decay(double x) {
  if (!(x < 700)) return 0;
  const double halvings = std::floor(x * 1.4426950408889634 + 0.5);
  // ln 2 in two parts, the first short enough for halvings * part to be exact.
  const double rest =
      (x - halvings * 0.693147180369123816490) - halvings * 1.90821492927058770002e-10;
  double sum = 1;
  for (int k = 13; k > 0; --k) sum = 1 - sum * rest / k;
  const auto exponent = static_cast<std::uint64_t>(1023 - static_cast<std::int64_t>(halvings));
  return sum * std::bit_cast<double>(exponent << 52);
}

double logarithm(double x) {
  if (!(x > 1e-300)) x = 1e-300;
  auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<std::int64_t>(bits >> 52) - 1023;
  bits = (bits & 0xfffffffffffffULL) | 0x3ff0000000000000ULL;
  auto mantissa = std::bit_cast<double>(bits);  // in [1, 2)
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++exponent;
  }
  const double s = (mantissa - 1) / (mantissa + 1);
  const double square = s * s;
  static constexpr auto coefficients = odd_reciprocals<12>();
  const double sum = square * polynomial<12>(coefficients, square);
  const auto e = static_cast<double>(exponent);
  return e * 0.693147180369123816490 + (2 * (s + s * sum) + e * 1.90821492927058770002e-10);
}

double angle(double y, double x) {
  constexpr double quarter = 0.78539816339744830962;  // pi / 4
  const double ax = std::fabs(x);
  const double ay = std::fabs(y);
  const double larger = ax > ay ? ax : ay;
  if (larger == 0) return 0;
  double t = (ax > ay ? ay : ax) / larger;
  const bool upper = t > 0.41421356237309503;  // tan(pi / 8)
  if (upper) t = (t - 1) / (t + 1);
  const double square = t * t;
  static constexpr auto coefficients = odd_reciprocals<20>();
  const double sum = -square * polynomial<20>(coefficients, -square);
  double result = t + t * sum;
  if (upper) result += quarter;
  if (ay > ax) result = 2 * quarter - result;
  if (x < 0) result = 4 * quarter - result;
  return y < 0 ? -result : result;
}

}  // namespace ziggurat::magnetism
