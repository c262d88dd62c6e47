// SPDX-License-Identifier: Apache-2.0
// Eight numbers at once, for functions that take a float or lanes of them (LanesOf, math/vec.h),
// and arrays of numbers for them. Not for public headers: programs that use the library may be
// compiled for any processor.
#pragma once

#include <immintrin.h>

#include <array>
#include <bit>
#include <cstddef>
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
    return Float8(_mm256_i32gather_ps(p, __m256i(index), sizeof(float)));
  }
  // Column c in element c, of the rows of four numbers that begin at `rows`, one for each lane.
  static std::array<Float8, 4> columns4(const std::array<const float*, kCount>& rows) {
    const auto both = [&](int lane) {  // two rows, four lanes apart
      return Float8(_mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(rows[lane])),
                                         _mm_loadu_ps(rows[lane + 4]), 1));
    };
    const Float8 a = both(0), b = both(1), c = both(2), d = both(3);
    const Float8 ab0 = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13),
                 ab2 = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15),
                 cd0 = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13),
                 cd2 = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    return {__builtin_shufflevector(ab0, cd0, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(ab0, cd0, 2, 3, 10, 11, 6, 7, 14, 15),
            __builtin_shufflevector(ab2, cd2, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(ab2, cd2, 2, 3, 10, 11, 6, 7, 14, 15)};
  }
  // Column c in element c, of the rows of eight numbers that begin at `rows`, one for each lane.
  static std::array<Float8, 8> columns(const std::array<const float*, kCount>& rows) {
    std::array<const float*, kCount> second;
    for (size_t lane = 0; lane < kCount; ++lane) second[lane] = rows[lane] + 4;
    const auto a = columns4(rows), b = columns4(second);
    return {a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]};
  }
};

// Arrays of numbers that are processed in lanes.

inline Float8 loadLanes(const float* from) { return Float8(_mm256_loadu_ps(from)); }
inline Int8 loadLanes(const int32_t* from) {
  return Int8(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
}
inline void storeLanes(float* to, Float8 v) { _mm256_storeu_ps(to, __m256(v)); }
inline void storeLanes(int32_t* to, Int8 v) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), __m256i(v));
}

// A bit for each lane whose condition (-1 or 0) holds.
inline unsigned bitsOf(Int8 condition) {
  return unsigned(_mm256_movemask_ps(__m256(Float8(condition))));
}
// The condition of the first `count` lanes.
inline Int8 firstLanes(size_t count) { return Int8{0, 1, 2, 3, 4, 5, 6, 7} < int32_t(count); }

// Stores the lanes of `bits` one after the other; writes eight numbers.
class LanePacking {
 public:
  explicit LanePacking(unsigned bits) : bits_(bits), order_(kOrders[bits]) {}

  unsigned bits() const { return bits_; }
  size_t count() const { return size_t(std::popcount(bits_)); }
  void store(float* to, Float8 v) const {
    storeLanes(to, Float8(_mm256_permutevar8x32_ps(__m256(v), __m256i(indices()))));
  }
  void store(int32_t* to, Int8 v) const {
    storeLanes(to, Int8(_mm256_permutevar8x32_epi32(__m256i(v), __m256i(indices()))));
  }

 private:
  Int8 indices() const {
    return Int8(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(&order_))));
  }

  // By bits: the numbers of the lanes, a byte each.
  static constexpr std::array<uint64_t, 256> kOrders = [] {
    std::array<uint64_t, 256> orders{};
    for (unsigned bits = 0; bits < orders.size(); ++bits)
      for (unsigned lane = 0, at = 0; lane < 8; ++lane)
        if (bits >> lane & 1) orders[bits] |= uint64_t(lane) << (8 * at++);
    return orders;
  }();

  unsigned bits_;
  uint64_t order_;
};

// Rays, and other things, in arrays: one for each of their numbers, for code that works in lanes.

// The arrays have room for one vector more than is used, since lanes are stored in whole vectors.
inline constexpr size_t kMostInArrays = 64, kArraySize = kMostInArrays + 8;
template <class T>
using LaneArray = std::array<T, kArraySize>;

// Vectors, or colours.
struct LaneArrays3 {
  alignas(64) LaneArray<float> x, y, z;

  Lanes3<Float8> load(size_t i) const {
    return {loadLanes(&x[i]), loadLanes(&y[i]), loadLanes(&z[i])};
  }
  void store(size_t i, const Lanes3<Float8>& v) {
    storeLanes(&x[i], v.x), storeLanes(&y[i], v.y), storeLanes(&z[i], v.z);
  }
  void store(size_t i, const Lanes3<Float8>& v, const LanePacking& packing) {
    packing.store(&x[i], v.x), packing.store(&y[i], v.y), packing.store(&z[i], v.z);
  }
  vec3 at(size_t i) const { return {x[i], y[i], z[i]}; }
  void set(size_t i, const vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

// Rays without an end; the directions are unit.
struct RayArrays {
  LaneArrays3 origin, direction;
};

}  // namespace chromeball
