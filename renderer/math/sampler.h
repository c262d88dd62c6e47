// SPDX-License-Identifier: Apache-2.0
// The random numbers of one path, a function of (pixel, sample, dimension, seed).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/hash.h"
#include "math/vec.h"

namespace chromeball {

// Owen-scrambled Sobol points, tabulated once for a render.

// The Sobol sequence's coordinate in one of its first four dimensions, as a 32-bit fraction
// (direction numbers of Joe and Kuo 2008).
uint32_t sobol(uint32_t index, int dimension);

// Nested uniform (Owen) scrambling of a 32-bit fraction: every prefix of bits chooses a permutation
// of the bits below it (Laine and Karras 2011, "Stratified Sampling for Stochastic Transparency",
// with the constants of Vegdahl 2021).
uint32_t owenScramble(uint32_t fraction, uint32_t seed);

// Points [0, 2^k) of a sequence with any number of dimensions. Four consecutive dimensions are one
// scrambled 4D Sobol sequence; the groups of four are padded: each visits its points in an
// independent nested-uniform order (Burley 2020, "Practical Hash-based Owen Scrambling"). Any
// aligned block of 2^j indices is as well distributed as the first 2^j.
class SobolTable {
 public:
  SobolTable(uint32_t points, int dimensions, uint64_t seed);  // points: a power of two

  uint32_t size() const { return size_; }
  int dimensions() const { return dimensions_; }
  const uint32_t* point(uint32_t index) const {
    return &fractions_[std::size_t(index) * dimensions_];
  }

 private:
  uint32_t size_;
  int dimensions_;
  std::vector<uint32_t> fractions_;
};

// The dimensions that a path uses, with how many numbers each purpose takes. Every vertex has a
// block of eight, two 4D groups of the table, however many its material and light use.
namespace dimension {
inline constexpr int kPixel = 0;     // 2: position in the pixel
inline constexpr int kLens = 2;      // 2
inline constexpr int kVertex = 4;    // first block
inline constexpr int kLight = 0;     // 2: direction towards the probe
inline constexpr int kBsdf = 2;      // 2: direction of the next ray
inline constexpr int kLobe = 4;      // 1: choice of a lobe
inline constexpr int kRoulette = 5;  // 1
inline constexpr int kEmitter = 6;   // 2: choice of a triangle and of a point on it
// 1 each: strategy or guide; BSDF or guide. Shared with kEmitter: the estimates of probe, emitters
// and the rest of the path are added, so they need not be independent.
inline constexpr int kGuide = 6, kBounce = 7;
inline constexpr int kPerVertex = 8;

// Deeper vertices contribute too little to profit from stratification; they use independent random
// numbers.
inline constexpr int kTabulatedVertices = 6;
// The number of dimensions that a table needs for paths of so many vertices.
constexpr int tabulated(int vertices) {
  return kVertex + kPerVertex * std::clamp(vertices, 1, kTabulatedVertices);
}
}  // namespace dimension

// What distinguishes the numbers of a pixel: of a block of its samples, sample i of which is point
// first + i stride of the table.
struct PixelNumbers {
  uint64_t key = 0;
  uint32_t first = 0, stride = 1;
  std::vector<uint32_t> shifts;  // by dimension
};

// Random numbers for the samples of pixels. All pixels share the table's points; each pixel and
// dimension XORs them with its own random number (a random digital shift), which preserves their
// stratification and makes each point uniform. A block is as many samples as the table has points;
// every block has its own shifts, and so is an independent randomisation.
class PixelSampler {
 public:
  PixelSampler(const SobolTable& table, uint64_t seed)
      : table_(&table), dimensions_(table.dimensions()), seed_(seed) {}

  void startPixel(uint32_t x, uint32_t y, uint64_t block) { set(own_, x, y, block); }
  void startSample(uint32_t i) { startSample(own_, i); }
  const PixelNumbers& pixel() const { return own_; }

  // The same for several pixels in turn, whose numbers the caller keeps.
  void set(PixelNumbers& pixel, uint32_t x, uint32_t y, uint64_t block, uint32_t first = 0,
           uint32_t stride = 1) const {
    pixel.first = first, pixel.stride = stride;
    pixel.key = hash(seed_, uint64_t(y) << 32 | x, block);
    pixel.shifts.resize(size_t(dimensions_));
    for (size_t d = 0; d < pixel.shifts.size(); d += 2) {
      const uint64_t bits = hash(pixel.key + d);
      pixel.shifts[d] = uint32_t(bits);
      pixel.shifts[d + 1] = uint32_t(bits >> 32);
    }
  }
  void startSample(const PixelNumbers& pixel, uint32_t i) { startSample(sampleAt(pixel, i)); }
  // Later dimensions are relative to the vertex's block.
  void startVertex(int depth) { base_ = blockOf(depth); }

  uint32_t bits(int d) const { return bitsOf(sample_, base_ + d); }
  float get1(int d) const { return toUnit(bits(d)); }
  // A number with 53 bits, to choose among more than 2^24 items; the lower 21 bits are not
  // stratified.
  double getFine1(int d) const {
    constexpr uint64_t kPurpose = 0x66696e65;  // separate random stream
    const uint64_t low = hash(sample_.key ^ kPurpose, sample_.index, uint64_t(d + base_)) >> 43;
    return (double(bits(d)) + double(low) * 0x1p-21) * 0x1p-32;
  }
  vec2 get2(int d) const { return {get1(d), get1(d + 1)}; }

  // The sample's time within the shutter interval: a separate dimension, used only for moving
  // scenes, padded to the dimensions of the table.
  float time() const {
    constexpr uint64_t kPurpose = 0x74696d65;  // separate random stream
    const uint64_t order = hash(seed_, kPurpose);
    const uint32_t index = owenScramble(sample_.index, uint32_t(order));
    return toUnit(owenScramble(sobol(index, 0), uint32_t(order >> 32)) ^
                  uint32_t(hash(sample_.key, kPurpose)));
  }

  // A key to hash for decisions that have no dimension of their own (stochastic alpha).
  uint32_t sampleKey() const { return keyOf(sample_, base_); }

  // The same for samples of many paths at once, which keep what identifies them.
  struct Sample {
    const uint32_t *point = nullptr, *shifts = nullptr;  // of the table, and of the pixel
    uint64_t key = 0;                                    // of the pixel
    uint32_t index = 0;                                  // in the block
  };
  Sample sampleAt(const PixelNumbers& pixel, uint32_t i) const {
    const uint32_t index = pixel.first + i * pixel.stride;
    return {table_->point(index), pixel.shifts.data(), pixel.key, index};
  }
  void startSample(const Sample& sample) {
    sample_ = sample;
    base_ = 0;
  }
  // A number before the first vertex's.
  uint32_t bits(const Sample& sample, int d) const { return bitsOf(sample, d); }
  // The bits of all kPerVertex numbers of a vertex.
  void vertexBits(const Sample& sample, int depth, uint32_t* out) const {
    const int base = blockOf(depth);
    const bool isTabulated = base + dimension::kPerVertex <= dimensions_;
    for (int d = 0; d < dimension::kPerVertex; ++d)
      out[d] =
          isTabulated ? sample.point[base + d] ^ sample.shifts[base + d] : bitsOf(sample, base + d);
  }
  static uint32_t vertexKey(const Sample& sample, int depth) {
    return keyOf(sample, blockOf(depth));
  }

 private:
  static int blockOf(int depth) { return dimension::kVertex + depth * dimension::kPerVertex; }
  uint32_t bitsOf(const Sample& sample, int d) const {
    if (d < dimensions_) return sample.point[d] ^ sample.shifts[d];
    return uint32_t(hash(sample.key, sample.index, uint64_t(d)));  // deep: not stratified
  }
  static uint32_t keyOf(const Sample& sample, int base) {
    return uint32_t(sample.key) ^ (sample.index * 0x9e3779b9u + uint32_t(base) * 0x85ebca6bu);
  }

  const SobolTable* table_;
  int dimensions_;
  uint64_t seed_;
  PixelNumbers own_;
  Sample sample_;
  int base_ = 0;
};

}  // namespace chromeball
