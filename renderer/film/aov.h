// SPDX-License-Identifier: Apache-2.0
// Arbitrary output variables (AOVs): layers beside a render's colour.
#pragma once

#include <string>
#include <vector>

#include "film/invalid.h"
#include "image/image.h"

namespace chromeball {

// The first surface that a camera ray meets.
struct FirstHit {
  bool hit = false;
  float depth = 0;  // metres along the camera's axis (planar depth, not the ray's length)
  Rgb albedo{0};    // base colour
  vec3 normal{0};   // unit shading normal, world space
  int material = -1, node = -1;
};

// The names are those of the command line and of the EXR's layers. Means over a pixel's samples:
//   albedo, normal  0 where nothing is hit      depth  over samples that hit something; else 1e10
//   alpha           fraction that hit one       material, node  index + 1 at the first sample that
//                                               hit; else 0 (a mean of numbers would mean nothing)
//   variance        squared standard error of the pixel (Film)        samples  their number (Film)
//   invalid         number of excluded samples: R with a NaN, G infinite, B negative
enum class Aov { Albedo, Normal, Depth, Alpha, Variance, Samples, Material, Node, Invalid };

struct AovInfo {
  Aov aov;
  const char* name;
  const char* channels;  // one letter each; empty: one channel that has the layer's name
};
const std::vector<AovInfo>& allAovs();
const AovInfo& aovInfo(Aov aov);
// `location` (an option, or FILE:LINE) begins the InputError thrown for an unknown name.
Aov aovFromName(const std::string& name, const std::string& location);

// Gathers the layers of the first hit, and the counts of excluded samples. Sums are doubles: in
// float they would stall after some million samples.
class AovFilm {
 public:
  AovFilm(int width, int height, const std::vector<Aov>& wanted);

  bool empty() const { return sums_.empty(); }

  // Adds a sample, or the defect of one. Concurrently for different pixels.
  void add(int x, int y, const FirstHit& first);
  void add(int x, int y, Defect defect);

  Image finished(Aov aov) const;

 private:
  struct Sum {
    Aov aov;
    int channels;
    std::vector<double> sums;
  };
  size_t pixel(int x, int y) const { return size_t(y) * width_ + x; }

  int width_, height_;
  std::vector<Sum> sums_;
  std::vector<uint32_t> samples_, hits_;  // number of samples, and of those that hit something
};

}  // namespace chromeball
