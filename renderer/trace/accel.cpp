// SPDX-License-Identifier: Apache-2.0
#include "trace/accel.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "base/error.h"
#include "base/hash.h"
#include "scene/surface.h"
#include "scene/thin_wall.h"
#include "trace/edge.h"
#include "trace/embree.h"

namespace chromeball {
namespace {

struct Query {
  QueryContext embree;  // first, so that a filter can cast back
  uint32_t key = 0;
  vec3 direction{0};
  Rgb transmittance{1};
};

// Index into Scene::instances, since geometry i of the top scene is instance i.
uint32_t instanceOf(uint32_t topInstance, uint32_t geometry) {
  return topInstance != RTC_INVALID_GEOMETRY_ID ? topInstance : geometry;
}

Hit hitOf(const RTCFilterFunctionNArguments* arguments) {
  RTCHitN* hit = arguments->hit;
  return {instanceOf(RTCHitN_instID(hit, 1, 0, 0), RTCHitN_geomID(hit, 1, 0)),
          RTCHitN_primID(hit, 1, 0),
          {RTCHitN_u(hit, 1, 0), RTCHitN_v(hit, 1, 0)},
          RTCRayN_tfar(arguments->ray, 1, 0)};
}

float alphaAt(const RTCFilterFunctionNArguments* arguments, const Hit& hit) {
  const auto& scene = *static_cast<const Scene*>(arguments->geometryUserPtr);
  return surfaceAlpha(scene, scene.instances[hit.instance], hit.triangle, hit.barycentric);
}

void filterClosest(const RTCFilterFunctionNArguments* arguments) {
  const auto& query = *reinterpret_cast<const Query*>(arguments->context);
  const Hit hit = hitOf(arguments);
  const float alpha = alphaAt(arguments, hit);
  const uint64_t surface = uint64_t(hit.instance) << 32 | hit.triangle;
  if (alpha < 1 && toUnit(uint32_t(hash(query.key, surface))) >= alpha) arguments->valid[0] = 0;
}

void filterShadow(const RTCFilterFunctionNArguments* arguments) {
  auto& query = *reinterpret_cast<Query*>(arguments->context);
  const auto& scene = *static_cast<const Scene*>(arguments->geometryUserPtr);
  const Hit hit = hitOf(arguments);
  const Instance& instance = scene.instances[hit.instance];
  if (scene.materials[instance.material].backLetsLightThrough() &&
      !isFromBehind(scene, instance, hit.triangle, query.direction)) {
    arguments->valid[0] = 0;
    return;
  }
  const float alpha = surfaceAlpha(scene, instance, hit.triangle, hit.barycentric);
  Rgb passed(1 - alpha);
  if (alpha > 0 && passesStraight(scene.materials[instance.material])) {
    const Surface surface =
        surfaceAt(scene, instance, hit.triangle, hit.barycentric, -query.direction);
    passed += alpha * straightTransmittance(scene, instance, surface, query.direction);
  }
  query.transmittance *= passed;
  if (!isBlack(query.transmittance)) arguments->valid[0] = 0;
}

RTCRay embreeRay(const Ray& ray, RayMask mask) {
  const vec3 &o = ray.origin, &d = ray.direction;
  return {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, ray.tMax, mask, 0, 0};
}

// Embree supports coordinates up to 1.8e18. The Debian build of Embree aborts the program for a ray
// beyond that, or with a NaN.
bool isTraceable(const Ray& ray) {
  constexpr float kFarthest = 1e18f;
  const vec3 sum = absolute(ray.origin) + absolute(ray.direction);
  return sum.x + sum.y + sum.z < kFarthest && ray.tMax >= 0;
}

constexpr size_t kPacket = 8;

void fillPacket(std::span<const Ray> rays, RayMask mask, int* valid, RTCRay8& r) {
  for (size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    valid[i] = isTraceable(ray) ? -1 : 0;
    r.org_x[i] = ray.origin.x, r.org_y[i] = ray.origin.y, r.org_z[i] = ray.origin.z;
    r.dir_x[i] = ray.direction.x, r.dir_y[i] = ray.direction.y, r.dir_z[i] = ray.direction.z;
    r.tnear[i] = r.time[i] = 0;
    r.tfar[i] = ray.tMax;
    r.mask[i] = mask;
    r.id[i] = r.flags[i] = 0;
  }
}

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
    if (!alpha && !passesStraight(material) && !material.backLetsLightThrough()) continue;
    needsFilter_[instance.mesh] = hasFilter_ = true;
    hasAlpha_ = hasAlpha_ || alpha;
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

bool Accel::closest(const Ray& ray, uint32_t key, RayMask mask, Hit& hit) const {
  if (!isTraceable(ray)) return false;
  Query query;
  initQueryContext(query.embree);
  query.key = key;
  RTCRayHit r;
  r.ray = embreeRay(ray, mask);
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect(scene_, r, query.embree);
  if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit = {instanceOf(r.hit.instID[0], r.hit.geomID), r.hit.primID, {r.hit.u, r.hit.v}, r.ray.tfar};
  return true;
}

// Replaces `hit` by the triangle in front of it if the ray grazes an edge (trace/edge.h); repeated
// up to three times, for corners. Triangles that share an edge are at similar distances; other hits
// of the turned ray are ignored.
void Accel::resolveEdge(Ray ray, uint32_t key, RayMask mask, Hit& hit) const {
  for (int i = 0; i < 3 && isNearEdge(hit); ++i) {
    const auto turned = turnedOffEdges(described_, ray, hit);
    Hit front;
    if (!turned || !closest(*turned, key, mask, front) ||
        (front.triangle == hit.triangle && front.instance == hit.instance) ||
        std::fabs(front.distance - hit.distance) > 0.5f * hit.distance)
      return;
    ray = *turned;
    hit = front;
  }
}

bool Accel::intersect(const Ray& ray, uint32_t key, Hit& hit, RayMask mask) const {
  if (!closest(ray, key, mask, hit)) return false;
  resolveEdge(ray, key, mask, hit);
  return true;
}

void Accel::intersectPacket(std::span<const Ray> rays, std::span<const uint32_t> keys,
                            Coherence coherence, std::span<std::optional<Hit>> hits,
                            RayMask mask) const {
  alignas(32) int valid[kPacket] = {};
  alignas(32) RTCRayHit8 r;
  fillPacket(rays, mask, valid, r.ray);
  for (size_t i = 0; i < rays.size(); ++i)
    r.hit.geomID[i] = r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  Query query;
  initQueryContext(query.embree);
  rtcIntersect(scene_, valid, r, coherence == Coherence::High, query.embree);
  for (size_t i = 0; i < rays.size(); ++i) {
    hits[i].reset();
    if (!valid[i] || r.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    hits[i] = {instanceOf(r.hit.instID[0][i], r.hit.geomID[i]),
               r.hit.primID[i],
               {r.hit.u[i], r.hit.v[i]},
               r.ray.tfar[i]};
    resolveEdge(rays[i], keys[i], mask, *hits[i]);
  }
}

void Accel::intersect(std::span<const Ray> rays, std::span<const uint32_t> keys,
                      Coherence coherence, std::span<std::optional<Hit>> hits, RayMask mask) const {
  assert(keys.size() == rays.size() && hits.size() == rays.size());
  for (size_t begin = 0; begin < rays.size(); begin += kPacket) {
    const size_t count = std::min(rays.size() - begin, kPacket);
    if (!hasAlpha_ && count > 1) {  // the filters process one ray at a time
      intersectPacket(rays.subspan(begin, count), keys.subspan(begin, count), coherence,
                      hits.subspan(begin, count), mask);
      continue;
    }
    for (size_t i = begin; i < begin + count; ++i) {
      Hit hit;
      hits[i] = intersect(rays[i], keys[i], hit, mask) ? std::optional(hit) : std::nullopt;
    }
  }
}

void Accel::occludedPacket(std::span<const Ray> rays, std::span<Rgb> transmittances,
                           RayMask mask) const {
  alignas(32) int valid[kPacket] = {};
  alignas(32) RTCRay8 r;
  fillPacket(rays, mask, valid, r);
  Query query;
  initQueryContext(query.embree);
  rtcOccluded(scene_, valid, r, query.embree);
  for (size_t i = 0; i < rays.size(); ++i)
    transmittances[i] = Rgb(valid[i] && r.tfar[i] < 0 ? 0.0f : 1.0f);
}

void Accel::transmittance(std::span<const Ray> rays, std::span<Rgb> transmittances,
                          RayMask mask) const {
  assert(transmittances.size() == rays.size());
  for (size_t begin = 0; begin < rays.size(); begin += kPacket) {
    const size_t count = std::min(rays.size() - begin, kPacket);
    if (!hasFilter_ && count > 1)  // the filters process one ray at a time
      occludedPacket(rays.subspan(begin, count), transmittances.subspan(begin, count), mask);
    else
      for (size_t i = begin; i < begin + count; ++i)
        transmittances[i] = transmittance(rays[i], mask);
  }
}

Rgb Accel::transmittance(const Ray& ray, RayMask mask) const {
  if (!isTraceable(ray)) return Rgb(1);
  Query query;
  initQueryContext(query.embree);
  query.direction = ray.direction;
  RTCRay r = embreeRay(ray, mask);
  rtcOccluded(scene_, r, query.embree);
  return r.tfar < 0 ? Rgb(0) : query.transmittance;
}

}  // namespace chromeball
