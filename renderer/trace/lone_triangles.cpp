// SPDX-License-Identifier: Apache-2.0
#include "trace/lone_triangles.h"

#include "trace/coincidence.h"

namespace chromeball {
namespace {

constexpr size_t kMostRemembered = 64'000'000;  // a byte each

}  // namespace

LoneTriangles::LoneTriangles(const Accel& accel) : accel_(accel) {
  const Scene& scene = accel.scene();
  if (scene.moves) return;  // surfaces may coincide for a moment
  size_t count = 0;
  std::vector<size_t> firsts;
  for (const Instance& instance : scene.instances) {
    const size_t triangles = scene.meshes[size_t(instance.mesh)].triangles.size();
    const bool isGlass = scene.materials[size_t(instance.material)].transmits();
    const bool isKept = isGlass && count + triangles <= kMostRemembered;
    firsts.push_back(isKept ? count : kNone);
    if (isKept) count += triangles;
  }
  if (count == 0) return;
  firsts_ = std::move(firsts);
  states_ = std::vector<std::atomic<State>>(count);
}

bool LoneTriangles::touchesOthers(uint32_t instance, uint32_t triangle) const {
  const Scene& scene = accel_.scene();
  const auto placed = [&](uint32_t i, uint32_t t) {
    return placedTriangle(scene, scene.instances[i], t, 0);
  };
  const Coincidence own(placed(instance, triangle));
  const float reach = own.radius() + float(4 * own.offset());
  bool isTouched = false;
  accel_.forEachNear(own.centre(), reach, 0, [&](uint32_t i, uint32_t t) {
    isTouched |= (i != instance || t != triangle) && own.mayTouch(placed(i, t), i == instance);
    return !isTouched;
  });
  return isTouched;
}

}  // namespace chromeball
