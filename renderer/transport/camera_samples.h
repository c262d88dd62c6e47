// SPDX-License-Identifier: Apache-2.0
// Camera rays that are traced together.
#pragma once

#include <span>
#include <vector>

#include "trace/hit_arrays.h"
#include "transport/camera_sample.h"

namespace chromeball {

// Samples (camera_sample.h), with the rays and hits in arrays. Keeps its memory, for many uses.
class CameraSamples {
 public:
  size_t size() const { return size_; }
  CameraSample operator[](size_t i) const;

  void clear() { size_ = 0; }
  // Adds sample `index` of the pixel; its ray is set later.
  void add(const CameraPixel& pixel, const PixelSampler& sampler, uint32_t index, float widening);
  void setRay(size_t i, const Ray& ray);
  // Sets the origins and directions of the rays [i, i + 8), in lanes.
  void setRays(size_t i, const Lanes3<Float8>& origins, const Lanes3<Float8>& directions);
  // Finds the closest hits of the rays.
  void findHits(const World& world, RayMask visible);

  // Where to write outputs of the samples (CameraSample::first, ::layers).
  void writeFirstHits(std::span<FirstHit> firsts) { firsts_ = firsts; }
  void writeLayers(std::span<Rgb> layers, size_t ofSample) {
    layers_ = layers, layerCount_ = ofSample;
  }

  const CameraPixel& pixel(size_t i) const { return *pixels_[i]; }
  const PixelSampler::Sample& numbers(size_t i) const { return numbers_[i]; }
  FirstHit* first(size_t i) const { return firsts_.empty() ? nullptr : &firsts_[i]; }
  float time(size_t i) const { return times_[i]; }
  vec3 direction(size_t i) const {
    return groups_[i / kMostInArrays].rays.direction.at(i % kMostInArrays);
  }

  // kMostInArrays of them.
  struct Group {
    RayArrays rays;
    HitArrays hits;
    alignas(64) LaneArray<float> widening;
  };
  const Group& group(size_t i) const { return groups_[i]; }

 private:
  void grow();
  void findMovingHits(const World& world, RayMask visible, size_t begin, size_t count);

  size_t size_ = 0;
  std::vector<const CameraPixel*> pixels_;
  std::vector<PixelSampler::Sample> numbers_;
  std::vector<float> times_;
  std::vector<uint32_t> keys_;
  std::vector<Group> groups_;
  std::span<FirstHit> firsts_;
  std::span<Rgb> layers_;
  size_t layerCount_ = 0;
};

}  // namespace chromeball
