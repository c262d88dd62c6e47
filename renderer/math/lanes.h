// SPDX-License-Identifier: Apache-2.0
// Eight numbers at once, for functions that take a float or lanes of them (LanesOf, math/vec.h).
// Not for public headers: programs that use the library may be compiled for any processor.
#pragma once

#include <immintrin.h>

#include <array>
#include <cstdint>

#include "math/vec.h"

namespace chromeball {

// Vectors of the compiler's (GCC, Clang), whose operators, comparisons and ?: act on each lane.
using Float8 = float __attribute__((vector_size(32)));
using Int8 = int32_t __attribute__((vector_size(32)));

template <>
struct LanesOf<Float8> {
  using Int = Int8;
  static constexpr int kCount = 8;

  static Float8 splat(float x) { return x - Float8{}; }
  static Float8 squareRoot(Float8 x) { return Float8(_mm256_sqrt_ps(__m256(x))); }
  static Float8 magnitude(Float8 x) { return Float8(Int8(x) & INT32_MAX); }
  static Float8 floor(Float8 x) { return Float8(_mm256_floor_ps(__m256(x))); }
  static Float8 nearest(Float8 x) {
    return Float8(_mm256_round_ps(__m256(x), _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC));
  }
  static Int8 toInt(Float8 x) { return __builtin_convertvector(x, Int8); }
  static Float8 toFloat(Int8 x) { return __builtin_convertvector(x, Float8); }
  static Int8 isNegative(Float8 x) { return Int8(x) < 0; }
  static Float8 withSignOf(Float8 x, Float8 sign) {
    return Float8((Int8(x) & INT32_MAX) | (Int8(sign) & INT32_MIN));
  }
  static Float8 gather(const float* p, Int8 index) {
    Float8 result;
    for (int k = 0; k < kCount; ++k) result[k] = p[index[k]];
    return result;
  }
  // Column c in element c, of the rows of eight numbers that begin at `rows`, one for each lane.
  static std::array<Float8, 8> columns(const std::array<const float*, kCount>& rows) {
    const auto half = [&](int lane, int first) {  // of two rows, four lanes apart
      return Float8(_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows[lane] + first)),
                                         _mm_loadu_ps(rows[lane + 4] + first), 1));
    };
    std::array<Float8, 8> result;
    for (int first = 0; first < 8; first += 4) {
      const Float8 a = half(0, first), b = half(1, first), c = half(2, first), d = half(3, first);
      const Float8 ab0 = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13),
                   ab2 = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15),
                   cd0 = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13),
                   cd2 = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
      result[first] = __builtin_shufflevector(ab0, cd0, 0, 1, 8, 9, 4, 5, 12, 13);
      result[first + 1] = __builtin_shufflevector(ab0, cd0, 2, 3, 10, 11, 6, 7, 14, 15);
      result[first + 2] = __builtin_shufflevector(ab2, cd2, 0, 1, 8, 9, 4, 5, 12, 13);
      result[first + 3] = __builtin_shufflevector(ab2, cd2, 2, 3, 10, 11, 6, 7, 14, 15);
    }
    return result;
  }
};

}  // namespace chromeball
