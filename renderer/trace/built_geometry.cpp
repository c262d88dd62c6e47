// SPDX-License-Identifier: Apache-2.0
#include "trace/built_geometry.h"

#include <new>

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/progress.h"
#include "trace/filter.h"

namespace chromeball {
namespace {

// The vertices of a time step, in Embree's memory, because it reads 16 bytes per vertex, past the
// end of an array of vec3. Null if there is none.
vec3* newVertices(RTCGeometry geometry, size_t step, size_t count) {
  return static_cast<vec3*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, unsigned(step), RTC_FORMAT_FLOAT3, sizeof(vec3), count));
}

struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using SceneInWork = std::unique_ptr<RTCSceneTy, ReleaseScene>;

}  // namespace

BuiltGeometry::BuiltGeometry(const Scene& scene) : scene_(scene), device_(rtcNewDevice(nullptr)) {
  if (device_) return;
  const RTCError error = rtcGetDeviceError(nullptr);
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
  throwRun("Embree cannot start: error {}", int(error));
}

BuiltGeometry::~BuiltGeometry() {
  releaseStatic();
  for (const auto& entry : meshScenes_) rtcReleaseScene(entry.second.scene);
  rtcReleaseDevice(device_);
}

void BuiltGeometry::releaseStatic() {
  if (static_) rtcReleaseScene(static_);
  static_ = nullptr;
  members_.clear();
}

void BuiltGeometry::begin(FilterUse filters) {
  const bool isOther = filters.any != filters_.any || filters.hasAlpha != filters_.hasAlpha;
  filters_ = std::move(filters);
  std::set<std::pair<const Mesh*, bool>> present;
  for (size_t i = 0; i < scene_.meshes.size(); ++i)
    present.insert({&scene_.meshes[i], filters_.ofMesh[i]});
  std::erase_if(meshScenes_, [&](const auto& entry) {
    if (!isOther && present.contains(entry.first)) return false;
    rtcReleaseScene(entry.second.scene);
    return true;
  });
  if (isOther) releaseStatic();
}

RTCSceneTy* BuiltGeometry::newScene() const {
  RTCScene scene = rtcNewScene(device_);
  // Robust: no ray passes between two triangles that share an edge.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  // The spatial splits of HIGH may report a hit to the shadow filter twice, which would apply its
  // transmittance twice.
  rtcSetSceneBuildQuality(scene, filters_.any ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH);
  return scene;
}

void BuiltGeometry::attach(RTCSceneTy* scene, RTCGeometryTy* geometry, uint32_t id, RayMask mask) {
  rtcSetGeometryMask(geometry, mask);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
}

void BuiltGeometry::commit(RTCSceneTy* scene) {
  static constexpr const char* kStage = "acceleration structures";
  const auto goesOn = [](void* monitor, double fraction) {
    auto& owner = *static_cast<WorkMonitor*>(monitor);
    owner.report(kStage, fraction);
    return !owner.isCancelled();
  };
  reportWork(kStage, 0);  // here, since Embree may report from its other threads alone
  if (WorkMonitor* const monitor = currentMonitor())
    rtcSetSceneProgressMonitorFunction(scene, goesOn, monitor);
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  endIfCancelled();
}

RTCGeometryTy* BuiltGeometry::newTriangles(int index) const {
  const Mesh& mesh = scene_.meshes[size_t(index)];
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
  if (filters_.ofMesh[size_t(index)]) {
    rtcSetGeometryUserData(geometry, const_cast<Scene*>(&scene_));
    if (filters_.hasAlpha) rtcSetGeometryIntersectFilterFunction(geometry, filterClosest);
    rtcSetGeometryOccludedFilterFunction(geometry, filterShadow);
  }
  return geometry;
}

RTCGeometryTy* BuiltGeometry::newGeometry(int index) const {
  const std::vector<vec3>& positions = scene_.meshes[size_t(index)].positions;
  RTCGeometry geometry = newTriangles(index);
  if (vec3* vertices = newVertices(geometry, 0, positions.size()))
    std::ranges::copy(positions, vertices);
  return geometry;
}

RTCGeometryTy* BuiltGeometry::newMovingGeometry(const Instance& instance) const {
  const std::vector<InstanceMotion::Key>& keys = instance.motion->keys;
  RTCGeometry geometry = newTriangles(instance.mesh);
  rtcSetGeometryTimeStepCount(geometry, unsigned(keys.size()));
  for (size_t k = 0; k < keys.size(); ++k) {
    const size_t count = keys[k].mesh->positions.size();
    if (vec3* vertices = newVertices(geometry, k, count))
      for (size_t i = 0; i < count; ++i) vertices[i] = keys[k].point(uint32_t(i));
  }
  return geometry;
}

RTCSceneTy* BuiltGeometry::meshScene(int index) {
  const MeshList::Shared& mesh = scene_.meshes.shared(size_t(index));
  MeshScene& entry = meshScenes_[{mesh.get(), filters_.ofMesh[size_t(index)]}];
  if (!entry.scene) {
    SceneInWork scene(newScene());
    attach(scene.get(), newGeometry(index), 0, kAllInstances);
    commit(scene.get());
    entry = {mesh, scene.release()};
    ++builds_;
  }
  return entry.scene;
}

RTCSceneTy* BuiltGeometry::staticScene(const std::vector<uint32_t>& instances,
                                       const std::vector<RayMask>& masks) {
  std::vector<Member> members;
  for (const uint32_t i : instances) {
    const size_t mesh = size_t(scene_.instances[i].mesh);
    members.push_back({i, scene_.meshes.shared(mesh), filters_.ofMesh[mesh],
                       masks.empty() ? kAllInstances : masks[i]});
  }
  if (static_ && members == members_) return static_;
  releaseStatic();
  SceneInWork scene(newScene());
  for (const Member& m : members)
    attach(scene.get(), newGeometry(scene_.instances[m.instance].mesh), m.instance, m.mask);
  commit(scene.get());
  static_ = scene.release();
  ++builds_;
  members_ = std::move(members);
  return static_;
}

}  // namespace chromeball
