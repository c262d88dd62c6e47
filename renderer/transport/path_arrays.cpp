// SPDX-License-Identifier: Apache-2.0
#include "transport/path_arrays.h"

namespace chromeball {

void PathArrays::add(const PathArrays& from, size_t i, const LanePacking& packing) {
  const auto copy = [&](auto& to, const auto& array) {
    packing.store(&to[size], loadLanes(&array[i]));
  };
  const auto copy3 = [&](LaneArrays3& to, const LaneArrays3& arrays) {
    to.store(size, arrays.load(i), packing);
  };
  copy3(rays.origin, from.rays.origin), copy3(rays.direction, from.rays.direction);
  copy3(throughput, from.throughput);
  copy(pdf, from.pdf), copy(length, from.length);
  copy(id, from.id), copy(scattered, from.scattered);
  copy(widening, from.widening), copy(minAlpha, from.minAlpha);
  copy(hits.instance, from.hits.instance), copy(hits.triangle, from.hits.triangle);
  copy(hits.u, from.hits.u), copy(hits.v, from.hits.v), copy(hits.distance, from.hits.distance);
  if (keepsVertices) {
    copy3(throughputBefore, from.throughputBefore);
    copy3(position, from.position), copy3(normal, from.normal);
  }
  size += packing.count();
}

}  // namespace chromeball
