// SPDX-License-Identifier: Apache-2.0
#include "trace/shared_places.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <vector>

#include "base/parallel.h"
#include "trace/coincidence.h"

namespace chromeball {

// `time`: when the places are compared. `budget`: the remaining number of comparisons, which it
// reduces.
void SharedPlaces::addPartnersOf(const Accel& accel, uint32_t instance, uint32_t triangle,
                                 float time, std::atomic<int64_t>& budget) {
  const Scene& scene = accel.scene();
  const auto placed = [&](uint32_t i, uint32_t t) {
    return placedTriangle(scene, scene.instances[i], t, time);
  };
  const Coincidence own(placed(instance, triangle));
  accel.forEachNear(own.centre(), own.radius(), time, [&](uint32_t i, uint32_t t) {
    if ((i != instance || t != triangle) && own.overlaps(placed(i, t))) {
      const std::scoped_lock lock(mutex_);
      triangles_.insert(keyOf(i, t));
      triangles_.insert(keyOf(instance, triangle));
    }
    return budget.fetch_sub(1, std::memory_order_relaxed) > 0;
  });
}

SharedPlaces::SharedPlaces(const Accel& accel) {
  const Scene& scene = accel.scene();
  // Surfaces that coincide for a while, not for a moment, do so at one of these times.
  std::vector<float> times{0};
  if (std::ranges::any_of(scene.instances, [](const Instance& i) { return i.motion != nullptr; }))
    times = {0, 0.25f, 0.5f, 0.75f, 1};
  // More comparisons would take seconds: beyond that, every triangle counts as sharing its place.
  std::atomic<int64_t> budget = 1'000'000 + 64 * int64_t(scene.triangleCount());
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Material& material = scene.materials[size_t(instance.material)];
    if (material.unlit || !material.emits()) continue;
    const auto count = uint32_t(scene.meshes[size_t(instance.mesh)].triangles.size());
    parallelFor(0u, count, [&](uint32_t t) {
      for (const float time : times)
        if (budget.load(std::memory_order_relaxed) > 0) addPartnersOf(accel, i, t, time, budget);
    });
  }
  all_ = budget <= 0;
}

}  // namespace chromeball
