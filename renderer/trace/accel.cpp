#include "trace/accel.h"

#include <algorithm>
#include <cstring>

#include "math/error.h"
#include "math/hash.h"
#include "scene/surface.h"
#include "trace/embree.h"

namespace chromeball {
namespace {

struct Query {
  QueryContext embree;  // first, so that a filter can cast back
  uint32_t key = 0;
  float transmittance = 1;
};

float alphaAt(const Accel::AlphaSource& source, const RTCFilterFunctionNArguments* arguments) {
  RTCHitN* hit = arguments->hit;
  const uint32_t triangle = RTCHitN_primID(hit, 1, 0);
  const vec2 barycentric(RTCHitN_u(hit, 1, 0), RTCHitN_v(hit, 1, 0));
  return surfaceAlpha(*source.scene, *source.mesh, *source.material, triangle, barycentric);
}

void filterClosest(const RTCFilterFunctionNArguments* arguments) {
  const auto& source = *static_cast<const Accel::AlphaSource*>(arguments->geometryUserPtr);
  const auto& query = *reinterpret_cast<const Query*>(arguments->context);
  const float alpha = alphaAt(source, arguments);
  const uint64_t surface = uint64_t(source.instance) << 32 | RTCHitN_primID(arguments->hit, 1, 0);
  if (alpha < 1 && toUnit(uint32_t(hash(query.key, surface))) >= alpha) arguments->valid[0] = 0;
}

void filterShadow(const RTCFilterFunctionNArguments* arguments) {
  const auto& source = *static_cast<const Accel::AlphaSource*>(arguments->geometryUserPtr);
  auto& query = *reinterpret_cast<Query*>(arguments->context);
  query.transmittance *= 1 - alphaAt(source, arguments);
  if (query.transmittance > 0) arguments->valid[0] = 0;
}

RTCGeometry meshGeometry(RTCDevice device, const Mesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Embree reads 16 bytes a vertex, past the end of an array of vec3: it gets its own copy.
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(vec3), mesh.positions.size());
  if (vertices)
    std::memcpy(vertices, mesh.positions.data(), mesh.positions.size() * sizeof(vec3));
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
  return geometry;
}

void setAlphaFilters(RTCGeometry geometry, Accel::AlphaSource& source) {
  rtcSetGeometryUserData(geometry, &source);
  rtcSetGeometryIntersectFilterFunction(geometry, filterClosest);
  rtcSetGeometryOccludedFilterFunction(geometry, filterShadow);
}

RTCScene newScene(RTCDevice device, bool hasAlpha) {
  RTCScene scene = rtcNewScene(device);
  // Robust: no ray slips between two triangles that share an edge.
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  // Spatial splits may report a hit to the shadow filter twice, which would darken it twice.
  rtcSetSceneBuildQuality(scene, hasAlpha ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_HIGH);
  return scene;
}

void attach(RTCScene scene, RTCGeometry geometry) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

void throwOnError(RTCDevice device) {
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throwRun("Embree cannot build the scene: {}",
             error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : fmt::format("error {}", int(error)));
}

}  // namespace

Accel::Accel(const Scene& scene) {
  device_ = rtcNewDevice(nullptr);
  if (!device_) throwRun("Embree cannot start: error {}", int(rtcGetDeviceError(nullptr)));
  try {
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

RTCSceneTy* Accel::meshScene(const Scene& scene, int mesh) {
  if (!meshScenes_[mesh]) {
    RTCGeometry geometry = meshGeometry(device_, scene.meshes[mesh]);
    if (alphaSources_[mesh].material) setAlphaFilters(geometry, alphaSources_[mesh]);
    meshScenes_[mesh] = newScene(device_, hasAlpha_);
    attach(meshScenes_[mesh], geometry);
    rtcCommitScene(meshScenes_[mesh]);
  }
  return meshScenes_[mesh];
}

void Accel::build(const Scene& scene) {
  std::vector<int> uses(scene.meshes.size());
  for (const Instance& instance : scene.instances) ++uses[instance.mesh];

  alphaSources_.resize(scene.meshes.size());
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    const Material& material = scene.materials[scene.meshes[i].material];
    if (material.alphaMode == AlphaMode::Opaque) continue;
    alphaSources_[i] = {&scene, &scene.meshes[i], &material, uint32_t(i)};
    hasAlpha_ = true;
  }

  meshScenes_.resize(scene.meshes.size());
  scene_ = newScene(device_, hasAlpha_);
  // Geometry i of the top scene is instance i of ours.
  for (const Instance& instance : scene.instances) {
    RTCGeometry geometry;
    if (uses[instance.mesh] == 1 && instance.toWorld.isIdentity()) {
      geometry = meshGeometry(device_, scene.meshes[instance.mesh]);
      AlphaSource& alpha = alphaSources_[instance.mesh];
      if (alpha.material) setAlphaFilters(geometry, alpha);
    } else {
      geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, meshScene(scene, instance.mesh));
      const Transform& t = instance.toWorld;
      float columns[12];
      std::memcpy(columns, &t.linear, sizeof t.linear);
      std::memcpy(columns + 9, &t.translation, sizeof t.translation);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    }
    attach(scene_, geometry);
  }
  rtcCommitScene(scene_);
  throwOnError(device_);
}

bool Accel::intersect(const Ray& ray, uint32_t key, Hit& hit) const {
  Query query;
  initQueryContext(query.embree);
  query.key = key;
  RTCRayHit r;
  r.ray = {ray.origin.x, ray.origin.y, ray.origin.z, 0, ray.direction.x, ray.direction.y,
           ray.direction.z, 0, ray.tMax, ~0u, 0, 0};
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect(scene_, r, query.embree);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  const bool instanced = r.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  hit = {instanced ? r.hit.instID[0] : r.hit.geomID, r.hit.primID, {r.hit.u, r.hit.v}};
  return true;
}

float Accel::transmittance(const Ray& ray) const {
  Query query;
  initQueryContext(query.embree);
  RTCRay r{ray.origin.x, ray.origin.y, ray.origin.z, 0, ray.direction.x, ray.direction.y,
           ray.direction.z, 0, ray.tMax, ~0u, 0, 0};
  rtcOccluded(scene_, r, query.embree);
  return r.tfar < 0 ? 0 : query.transmittance;
}

}  // namespace chromeball
