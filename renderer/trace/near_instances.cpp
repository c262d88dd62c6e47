// SPDX-License-Identifier: Apache-2.0
#include "trace/near_instances.h"

#include <algorithm>
#include <limits>

#include "trace/built_geometry.h"
#include "trace/embree.h"

namespace chromeball {
namespace {

Transform keyOf(const InstanceMotion::Key& key) { return key.toWorld.value_or(Transform{}); }

// Embree interpolates the elements of the matrices of moving instances.
Transform placementAt(const Instance& instance, float time) {
  if (!instance.motion) return instance.toWorld.value_or(Transform{});
  const KeySpan span = instance.motion->at(time);
  const Transform from = keyOf(instance.motion->keys[span.from]),
                  to = keyOf(instance.motion->keys[span.to]);
  Transform mixed;
  mixed.linear = from.linear + span.fraction * (to.linear - from.linear);
  mixed.translation = glm::mix(from.translation, to.translation, span.fraction);
  return mixed;
}

// While it moves, vertices move along straight lines between the keys.
RTCBounds boundsOf(const Instance& instance, RTCScene mesh) {
  RTCBounds own;
  rtcGetSceneBounds(mesh, &own);
  vec3 lower(std::numeric_limits<float>::infinity()), upper(-lower), sizes(0);
  const auto add = [&](const Transform& toWorld) {
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 at(corner & 1 ? own.lower_x : own.upper_x, corner & 2 ? own.lower_y : own.upper_y,
                    corner & 4 ? own.lower_z : own.upper_z);
      const vec3 p = toWorld.point(at);
      lower = glm::min(lower, p), upper = glm::max(upper, p);
      sizes = glm::max(sizes, toWorld.reach(at));
    }
  };
  if (instance.motion)
    for (const InstanceMotion::Key& key : instance.motion->keys) add(keyOf(key));
  else
    add(instance.toWorld.value_or(Transform{}));
  constexpr float kRoundings = 8 * std::numeric_limits<float>::epsilon();
  const vec3 margin = kRoundings * sizes;
  lower -= margin, upper += margin;
  return {lower.x, lower.y, lower.z, 0, upper.x, upper.y, upper.z, 0};
}

}  // namespace

struct NearInstances::Search {
  const NearInstances& owner;
  vec3 point;
  float radius, time;
  Visit visit;
  void* visitor;
  uint32_t instance = 0;  // in whose space the search is
  bool goesOn = true;

  void searchMesh(const Placed& placed) {
    const Transform toWorld = placementAt(owner.scene_.instances[placed.instance], time);
    const glm::dmat3 toMesh = glm::inverse(glm::dmat3(toWorld.linear));
    const vec3 local(toMesh * (glm::dvec3(point) - glm::dvec3(toWorld.translation)));
    double stretch2 = 0;  // at least that of any direction
    for (int i = 0; i < 3; ++i) stretch2 += glm::dot(toMesh[i], toMesh[i]);
    constexpr float kRoundings = 4 * std::numeric_limits<float>::epsilon();
    const float reach =
        radius * float(std::sqrt(stretch2)) + kRoundings * maxComponent(absolute(local));
    instance = placed.instance;
    RTCPointQuery query{local.x, local.y, local.z, 0, reach};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(placed.mesh, &query, &context, visitTriangle, this);
  }

  // An ended search has no radius.
  static bool visitTriangle(RTCPointQueryFunctionArguments* arguments) {
    auto& search = *static_cast<Search*>(arguments->userPtr);
    if (search.goesOn)
      search.goesOn = search.visit(search.instance, arguments->primID, search.visitor);
    if (!search.goesOn) arguments->query->radius = 0;
    return !search.goesOn;
  }
  static bool visitBox(RTCPointQueryFunctionArguments* arguments) {
    auto& search = *static_cast<Search*>(arguments->userPtr);
    if (search.goesOn) search.searchMesh(search.owner.placed_[arguments->primID]);
    if (!search.goesOn) arguments->query->radius = 0;
    return !search.goesOn;
  }
};

NearInstances::NearInstances(RTCDeviceTy* device, const Scene& scene, std::vector<Placed> placed)
    : scene_(scene), placed_(std::move(placed)), boxes_(rtcNewScene(device)) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(placed_.size()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* arguments) {
        const auto& owner = *static_cast<const NearInstances*>(arguments->geometryUserPtr);
        const Placed& own = owner.placed_[arguments->primID];
        *arguments->bounds_o = boundsOf(owner.scene_.instances[own.instance], own.mesh);
      },
      nullptr);
  BuiltGeometry::attach(boxes_, geometry, 0, kAllInstances);
  BuiltGeometry::commit(boxes_);
}

NearInstances::~NearInstances() { rtcReleaseScene(boxes_); }

bool NearInstances::search(const vec3& point, float radius, float time, Visit visit,
                           void* visitor) const {
  Search own{*this, point, radius, time, visit, visitor};
  RTCPointQuery query{point.x, point.y, point.z, time, radius};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(boxes_, &query, &context, Search::visitBox, &own);
  return own.goesOn;
}

}  // namespace chromeball
