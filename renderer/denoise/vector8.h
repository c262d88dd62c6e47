// SPDX-License-Identifier: Apache-2.0
// Eight floats of consecutive pixels, processed together.
#pragma once

#include <cstdint>
#include <cstring>

namespace chromeball {

constexpr int kLanes = 8;
using Float8 = float __attribute__((vector_size(32)));
using Int8 = int32_t __attribute__((vector_size(32)));

inline Float8 load8(const float* from) {
  Float8 v;
  std::memcpy(&v, from, sizeof(v));
  return v;
}
inline void store8(float* to, Float8 v) { std::memcpy(to, &v, sizeof(v)); }
inline Float8 splat8(float x) { return Float8{} + x; }
inline Float8 max8(Float8 a, Float8 b) { return a > b ? a : b; }
inline Float8 min8(Float8 a, Float8 b) { return a < b ? a : b; }

inline bool anyAbove(Float8 v, float limit) {
  const Int8 above = v > limit;
  int any = 0;
  for (int k = 0; k < kLanes; ++k) any |= above[k];
  return any != 0;
}

// exp(-x) for x >= 0, relative error below 1e-5; 0 beyond 40.
inline Float8 expOfMinus(Float8 x) {
  const Float8 t = min8(x, splat8(60)) * -1.44269504f;
  const Int8 whole = __builtin_convertvector(t - 0.5f, Int8);  // rounds towards zero: nearest
  const Float8 f = (t - __builtin_convertvector(whole, Float8)) * 0.693147181f;
  const Float8 series =
      1 + f * (1 + f * (0.5f + f * (1 / 6.0f + f * (1 / 24.0f + f * (1 / 120.0f)))));
  const Int8 exponent = (whole + 127) << 23;
  Float8 power;
  std::memcpy(&power, &exponent, sizeof(power));
  return x > 40.0f ? Float8{} : power * series;
}

}  // namespace chromeball
