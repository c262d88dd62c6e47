// SPDX-License-Identifier: Apache-2.0
// Building the acceleration structure.
#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <tuple>

#include "base/error.h"
#include "base/progress.h"
#include "scene/extended_surface.h"
#include "trace/accel.h"
#include "trace/built_geometry.h"
#include "trace/filter.h"
#include "trace/near_instances.h"

namespace chromeball {
namespace {

void throwOnError(RTCDevice device) {
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throwRun("Embree cannot build the scene: {}", error == RTC_ERROR_OUT_OF_MEMORY
                                                      ? "out of memory"
                                                      : fmt::format("error {}", int(error)));
}

std::array<float, 12> columnsOf(const Transform& toWorld) {
  std::array<float, 12> columns;
  std::memcpy(columns.data(), &toWorld.linear, sizeof toWorld.linear);
  std::memcpy(columns.data() + 9, &toWorld.translation, sizeof toWorld.translation);
  return columns;
}

void setTransform(RTCGeometry geometry, unsigned step, const Transform& toWorld) {
  rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                          columnsOf(toWorld).data());
}

RTCGeometry newInstance(RTCDevice device, RTCScene scene, const Transform& toWorld) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, scene);
  setTransform(geometry, 0, toWorld);
  return geometry;
}

// Embree interpolates the transforms' elements, so that vertices move along straight lines.
RTCGeometry newMovingInstance(RTCDevice device, RTCScene scene, const InstanceMotion& motion) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, scene);
  rtcSetGeometryTimeStepCount(geometry, unsigned(motion.keys.size()));
  for (size_t k = 0; k < motion.keys.size(); ++k)
    setTransform(geometry, unsigned(k), motion.keys[k].toWorld.value_or(Transform{}));
  return geometry;
}

// The instances in world space that do not move, if others move; else none.
std::vector<uint32_t> staticInstances(const Scene& scene, const std::vector<int>& uses) {
  std::vector<uint32_t> still;
  if (std::ranges::none_of(scene.instances, &Instance::moves)) return still;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (!instance.moves && !instance.toWorld && uses[size_t(instance.mesh)] == 1)
      still.push_back(uint32_t(i));
  }
  return still;
}

// A key that is equal for instances that rays cannot tell apart.
auto placementOf(const Scene& scene, uint32_t instance, RayMask mask) {
  const Instance& i = scene.instances[instance];
  return std::tuple(i.mesh, i.material, mask, columnsOf(i.toWorld.value_or(Transform{})));
}

// For each instance, whether there are enough equal ones without it: more would only cost time. One
// opaque instance is enough; of instances that light passes, kMost are kept.
std::vector<bool> redundantInstances(const Scene& scene, const std::vector<int>& uses,
                                     const Accel& accel) {
  constexpr size_t kMost = 8;
  std::vector<uint32_t> shared;
  for (uint32_t i = 0; i < scene.instances.size(); ++i)
    if (uses[size_t(scene.instances[i].mesh)] > 1 && !scene.instances[i].motion)
      shared.push_back(i);
  const auto placement = [&](uint32_t i) { return placementOf(scene, i, accel.mask(i)); };
  std::ranges::stable_sort(shared, {}, placement);
  std::vector<bool> redundant(scene.instances.size());
  for (size_t begin = 0, end; begin < shared.size(); begin = end) {
    for (end = begin + 1;
         end < shared.size() && placement(shared[end]) == placement(shared[begin]);)
      ++end;
    const Material& m = scene.materials[size_t(scene.instances[shared[begin]].material)];
    const bool isOpaque = m.alphaMode == AlphaMode::Opaque && !m.transmits();
    for (size_t k = begin + (isOpaque ? 1 : kMost); k < end; ++k) redundant[shared[k]] = true;
  }
  return redundant;
}

FilterUse filterUse(const Scene& scene) {
  FilterUse use{std::vector<bool>(scene.meshes.size())};
  for (const Instance& instance : scene.instances) {
    const Material& material = scene.materials[size_t(instance.material)];
    const bool alpha = material.alphaMode != AlphaMode::Opaque;
    if (!alpha && !passesShadows(material) && !material.backLetsLightThrough()) continue;
    use.ofMesh[size_t(instance.mesh)] = use.any = true;
    use.hasAlpha = use.hasAlpha || alpha;
    use.needsMedia = use.needsMedia || material.straightShadows || (alpha && material.isBody());
  }
  return use;
}

}  // namespace

Accel::Accel(const Scene& scene, const std::vector<RayMask>& masks,
             std::shared_ptr<BuiltGeometry> earlier)
    : described_(scene),
      masks_(masks),
      built_(earlier ? std::move(earlier) : std::make_shared<BuiltGeometry>(scene)) {
  assert(masks.empty() || masks.size() == scene.instances.size());
  assert(&built_->scene() == &scene);
  RTCDevice device = built_->device();
  if (!masks.empty() && !rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED))
    throwRun("this build of Embree has no ray masks (EMBREE_RAY_MASK), which composites need");
  try {
    build();
    throwOnError(device);
  } catch (...) {
    if (scene_) rtcReleaseScene(scene_);
    throw;
  }
}

Accel::~Accel() { rtcReleaseScene(scene_); }

// Geometry i of the top scene is instance i of ours; the instances that do not move are one more
// geometry, so that it is built once.
void Accel::build() {
  const Scene& scene = described_;
  const FilterUse use = filterUse(scene);
  hasFilter_ = use.any;
  hasAlpha_ = use.hasAlpha;
  needsMedia_ = use.needsMedia;
  built_->begin(use);
  std::vector<int> uses(scene.meshes.size());
  for (const Instance& instance : scene.instances) ++uses[size_t(instance.mesh)];
  const std::vector<uint32_t> still = staticInstances(scene, uses);

  const auto isTracedAsInstance = [&](const Instance& instance) {
    if (instance.motion) return instance.motion->isRigid();
    return uses[size_t(instance.mesh)] > 1 || instance.toWorld;
  };
  const auto geometryOf = [&](const Instance& instance) -> RTCGeometry {
    if (!isTracedAsInstance(instance))
      return instance.motion ? built_->newMovingGeometry(instance)
                             : built_->newGeometry(instance.mesh);
    const RTCScene mesh = built_->meshScene(instance.mesh);
    return instance.motion
               ? newMovingInstance(built_->device(), mesh, *instance.motion)
               : newInstance(built_->device(), mesh, instance.toWorld.value_or(Transform{}));
  };
  std::vector<NearInstances::Placed> placed;
  const std::vector<bool> redundant = redundantInstances(scene, uses, *this);
  scene_ = built_->newScene();
  if (rtcGetDeviceProperty(built_->device(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED))
    widest_ = 16;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    if (redundant[i] || std::ranges::binary_search(still, uint32_t(i))) continue;
    endIfCancelled();
    const Instance& instance = scene.instances[i];
    BuiltGeometry::attach(scene_, geometryOf(instance), uint32_t(i), mask(uint32_t(i)));
    if (isTracedAsInstance(instance))
      placed.push_back({uint32_t(i), built_->meshScene(instance.mesh)});
  }
  if (!still.empty())
    BuiltGeometry::attach(
        scene_, newInstance(built_->device(), built_->staticScene(still, masks_), Transform{}),
        uint32_t(scene.instances.size()), kAllInstances);
  BuiltGeometry::commit(scene_);
  if (!placed.empty())
    nearInstances_ = std::make_unique<NearInstances>(built_->device(), scene, std::move(placed));
}

}  // namespace chromeball
