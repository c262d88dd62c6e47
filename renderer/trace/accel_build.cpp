// SPDX-License-Identifier: Apache-2.0
// Building the acceleration structure.
#include <cassert>
#include <cstring>

#include "base/error.h"
#include "scene/thin_wall.h"
#include "trace/accel.h"
#include "trace/filter.h"

namespace chromeball {
namespace {

RTCScene newScene(RTCDevice device, bool hasFilter) {
  RTCScene scene = rtcNewScene(device);
  // Robust: no ray passes between two triangles that share an edge.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  // The spatial splits of HIGH may report a hit to the shadow filter twice, which would apply its
  // transmittance twice.
  rtcSetSceneBuildQuality(scene, hasFilter ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH);
  return scene;
}

void attach(RTCScene scene, RTCGeometry geometry, uint32_t id, RayMask mask) {
  rtcSetGeometryMask(geometry, mask);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

void throwOnError(RTCDevice device) {
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throwRun("Embree cannot build the scene: {}", error == RTC_ERROR_OUT_OF_MEMORY
                                                      ? "out of memory"
                                                      : fmt::format("error {}", int(error)));
}

}  // namespace

Accel::Accel(const Scene& scene, const std::vector<RayMask>& masks)
    : described_(scene), masks_(masks) {
  assert(masks.empty() || masks.size() == scene.instances.size());
  device_ = rtcNewDevice(nullptr);
  if (!device_) throwRun("Embree cannot start: error {}", int(rtcGetDeviceError(nullptr)));
  try {
    if (!masks.empty() && !rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED))
      throwRun("this build of Embree has no ray masks (EMBREE_RAY_MASK), which composites need");
    build(scene);
  } catch (...) {
    release();
    throw;
  }
}

Accel::~Accel() { release(); }

void Accel::release() {
  if (scene_) rtcReleaseScene(scene_);
  for (RTCScene meshScene : meshScenes_)
    if (meshScene) rtcReleaseScene(meshScene);
  rtcReleaseDevice(device_);
}

RTCGeometryTy* Accel::meshGeometry(const Scene& scene, int index) const {
  const Mesh& mesh = scene.meshes[index];
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Copied, because Embree reads 16 bytes per vertex, past the end of an array of vec3.
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(vec3), mesh.positions.size());
  if (vertices) std::memcpy(vertices, mesh.positions.data(), mesh.positions.size() * sizeof(vec3));
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
  if (needsFilter_[index]) {
    rtcSetGeometryUserData(geometry, const_cast<Scene*>(&scene));
    if (hasAlpha_) rtcSetGeometryIntersectFilterFunction(geometry, filterClosest);
    rtcSetGeometryOccludedFilterFunction(geometry, filterShadow);
  }
  return geometry;
}

RTCSceneTy* Accel::meshScene(const Scene& scene, int mesh) {
  if (!meshScenes_[mesh]) {
    meshScenes_[mesh] = newScene(device_, hasFilter_);
    attach(meshScenes_[mesh], meshGeometry(scene, mesh), 0, kAllInstances);
    rtcCommitScene(meshScenes_[mesh]);
  }
  return meshScenes_[mesh];
}

void Accel::build(const Scene& scene) {
  std::vector<int> uses(scene.meshes.size());
  needsFilter_.resize(scene.meshes.size());
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    ++uses[instance.mesh];
    const Material& material = scene.materials[instance.material];
    const bool alpha = material.alphaMode != AlphaMode::Opaque;
    if (!alpha && !passesShadows(material) && !material.backLetsLightThrough()) continue;
    needsFilter_[instance.mesh] = hasFilter_ = true;
    hasAlpha_ = hasAlpha_ || alpha;
    hasStraightBodies_ = hasStraightBodies_ || material.straightShadows;
  }

  meshScenes_.resize(scene.meshes.size());
  scene_ = newScene(device_, hasFilter_);
  // Geometry i of the top scene is instance i of ours.
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    RTCGeometry geometry;
    if (uses[instance.mesh] == 1 && !instance.toWorld) {
      geometry = meshGeometry(scene, instance.mesh);
    } else {
      geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, meshScene(scene, instance.mesh));
      const Transform t = instance.toWorld.value_or(Transform{});
      float columns[12];
      std::memcpy(columns, &t.linear, sizeof t.linear);
      std::memcpy(columns + 9, &t.translation, sizeof t.translation);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    }
    attach(scene_, geometry, uint32_t(i), mask(uint32_t(i)));
  }
  rtcCommitScene(scene_);
  throwOnError(device_);
}

}  // namespace chromeball
