// SPDX-License-Identifier: Apache-2.0
#include "transport/camera_samples.h"

#include <algorithm>

#include "trace/accel.h"

namespace chromeball {

CameraSample CameraSamples::operator[](size_t i) const {
  const Group& group = groups_[i / kMostInArrays];
  const size_t k = i % kMostInArrays;
  const Ray ray{group.rays.origin.at(k), group.rays.direction.at(k), INFINITY, times_[i]};
  return {.pixel = pixels_[i],
          .numbers = numbers_[i],
          .ray = ray,
          .hit = group.hits.at(k),
          .widening = group.widening[k],
          .first = first(i),
          .layers = layers_.subspan(i * layerCount_, layerCount_)};
}

void CameraSamples::grow() {
  groups_.emplace_back();
  const size_t size = groups_.size() * kMostInArrays;
  pixels_.resize(size), numbers_.resize(size), times_.resize(size), keys_.resize(size);
}

void CameraSamples::add(const CameraPixel& pixel, const PixelSampler& sampler, uint32_t index,
                        float widening) {
  const size_t i = size_++;
  if (i == pixels_.size()) grow();
  groups_[i / kMostInArrays].widening[i % kMostInArrays] = widening;
  pixels_[i] = &pixel;
  numbers_[i] = sampler.sampleAt(pixel.numbers, index);
  times_[i] = 0;
  // Other surfaces at the place of a hit are met with the keys of the vertex.
  keys_[i] = PixelSampler::vertexKey(numbers_[i], 0);
}

void CameraSamples::setRay(size_t i, const Ray& ray) {
  RayArrays& rays = groups_[i / kMostInArrays].rays;
  rays.origin.set(i % kMostInArrays, ray.origin);
  rays.direction.set(i % kMostInArrays, ray.direction);
  times_[i] = ray.time;
}

void CameraSamples::setRays(size_t i, const Lanes3<Float8>& origins,
                            const Lanes3<Float8>& directions) {
  RayArrays& rays = groups_[i / kMostInArrays].rays;
  rays.origin.store(i % kMostInArrays, origins);
  rays.direction.store(i % kMostInArrays, directions);
}

void CameraSamples::findHits(const World& world, RayMask visible) {
  for (size_t begin = 0; begin < size(); begin += kMostInArrays) {
    const size_t count = std::min(kMostInArrays, size() - begin);
    if (world.scene.moves) {
      findMovingHits(world, visible, begin, count);
      continue;
    }
    Group& group = groups_[begin / kMostInArrays];
    world.accel.intersect(group.rays, count, std::span(keys_).subspan(begin, count),
                          Accel::Coherence::High, group.hits, visible);
  }
}

// Of rays at different times.
void CameraSamples::findMovingHits(const World& world, RayMask visible, size_t begin,
                                   size_t count) {
  std::array<Ray, kMostInArrays> rays;
  std::array<std::optional<Hit>, kMostInArrays> hits;
  Group& group = groups_[begin / kMostInArrays];
  for (size_t k = 0; k < count; ++k)
    rays[k] = {group.rays.origin.at(k), group.rays.direction.at(k), INFINITY, times_[begin + k]};
  world.accel.intersect(std::span(rays).first(count), std::span(keys_).subspan(begin, count),
                        Accel::Coherence::High, std::span(hits).first(count), visible);
  for (size_t k = 0; k < count; ++k) group.hits.set(k, hits[k]);
}

}  // namespace chromeball
