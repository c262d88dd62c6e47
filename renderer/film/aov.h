// SPDX-License-Identifier: Apache-2.0
// Arbitrary output variables (AOVs): additional layers of a render.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/archive.h"
#include "film/film.h"
#include "film/rows.h"
#include "image/image.h"

namespace chromeball {

// The first surface that a camera ray meets.
struct FirstHit {
  bool hit = false;
  float depth = 0;  // metres along the path; PixelRenderer makes it that along the camera's axis
  Rgb albedo{0};    // base colour
  vec3 normal{0};   // unit shading normal, world space
  int material = -1, node = -1;
  // What the camera sees behind mirrors, glass and other narrow lobes: the base colour of the last
  // such surface or of the one behind, weighted by the throughput; or radiance L of the probe, as
  // L / (L + its median). For a denoiser: the reflected and refracted details.
  Rgb seen{0};
  // Radiance found before the path's second scattering by a broad lobe; none: all of the path's.
  std::optional<Rgb> direct;

  // Results of approximate/occlusion.h, from one sample.
  float ambientOcclusion = 0;  // 1 where the sky is visible
  vec3 unoccluded{0};          // its direction
  Rgb irradiance{0};           // W/m^2
};

// The names are the same on the command line and in the EXR file. Values per pixel:
//   albedo, normal  mean over all samples; a sample without a hit counts as 0
//   depth           mean over the samples with a hit; 1e10 if none
//   alpha           fraction of samples with a hit
//   variance        squared standard error of the pixel (Film)
//   samples         number of samples (Film)
//   material, node  index + 1, of the first sample with a hit (indices cannot be averaged); 0 if
//                   none
//   invalid         number of excluded samples: R NaN, G infinite, B negative
//   ao              ambient occlusion: the visible part of the sky, weighted by the cosine; mean
//                   over the samples with a hit, 0 if none
//   bent_normal     unit, the mean direction of the visible sky; 0 if there is none
//   irradiance      W/m^2, of the light on the first surface; mean over the samples with a hit
//   denoise         what a denoiser reads: several layers (film/layer_film.h)
// Parts of renders store their numbers: a new one is the last.
enum class Aov {
  Albedo,
  Normal,
  Depth,
  Alpha,
  Variance,
  Samples,
  Material,
  Node,
  Invalid,
  Denoise,
  AmbientOcclusion,
  BentNormal,
  Irradiance
};

struct AovInfo {
  Aov aov;
  const char* name;
  const char* channels;  // one letter each; empty: one channel that has the layer's name
  // What is summed over the hits, in as many channels; null: nothing (an index, or the Film's).
  vec3 (*summed)(const FirstHit&) = nullptr;
};
const std::vector<AovInfo>& allAovs();
const AovInfo& aovInfo(Aov aov);
// `location` (an option, or FILE:LINE) begins the InputError thrown for an unknown name.
Aov aovFromName(const std::string& name, const std::string& location);

// Accumulates the layers of the first hit and the counts of excluded samples. Sums are in double:
// a float sum stops growing after some million samples.
class AovFilm {
 public:
  AovFilm(int width, int height, const std::vector<Aov>& wanted);

  bool empty() const { return sums_.empty(); }

  // Adds a sample, or the defect of one. Thread-safe for different pixels.
  void add(int x, int y, const FirstHit& first);
  void add(int x, int y, Defect defect);

  // The same as Film::add(), copyPixels(), part() and archive(). add() keeps this film's indices.
  void add(const AovFilm& part, int x, int y);
  void copyPixels(const AovFilm& from, const PixelRect& rect);
  AovFilm part(const PixelRect& rect) const;
  void archive(Archive& a, Rows rows);

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
  std::vector<uint32_t> samples_, hits_;  // per pixel: samples, and samples with a hit
};

}  // namespace chromeball
