// SPDX-License-Identifier: Apache-2.0
// Surfaces that coincide with one that a ray has hit.
#include <array>
#include <cmath>

#include "trace/accel.h"
#include "trace/filter.h"
#include "trace/near_instances.h"

namespace chromeball {
namespace {

using glm::dvec3;

// A triangle in relation to a point.
class CoincidentTriangle {
 public:
  explicit CoincidentTriangle(const PlacedTriangle& triangle)
      : sizes_(triangle.sizes),
        corners_{dvec3(triangle.corners[0]), dvec3(triangle.corners[1]),
                 dvec3(triangle.corners[2])},
        normal_(glm::cross(corners_[1] - corners_[0], corners_[2] - corners_[0])),
        area_(glm::length(normal_)) {}

  double cosine(const dvec3& direction) const { return glm::dot(normal_, direction) / area_; }
  bool isParallel(const dvec3& direction) const {
    constexpr double kLeast = 1e-3;
    return !(std::fabs(cosine(direction)) > kLeast);  // or degenerate
  }
  double along(const dvec3& direction, const dvec3& from) const {
    return glm::dot(normal_, corners_[0] - from) / glm::dot(normal_, direction);
  }
  double offset() const { return rayOffset(sizes_, vec3(normal_ / area_)); }

  // Whether a point of the plane lies in the triangle, at least `margin` metres from its edges. If
  // two triangles share an edge, exactly one contains the points of the edge.
  bool contains(const dvec3& point, double margin) const {
    for (int i = 0; i < 3; ++i) {
      const dvec3 &start = corners_[size_t(i)], &end = corners_[size_t((i + 1) % 3)];
      const bool owns = isBefore(start, end);
      // The ends have the same order for both triangles, so that the results are exactly opposite.
      const dvec3 &from = owns ? start : end, &to = owns ? end : start;
      const double side = glm::dot(glm::cross(to - from, point - from), normal_) / area_;
      const double inwards = owns ? side : -side, least = margin * glm::length(to - from);
      if (inwards < least || (inwards == least && !owns)) return false;
    }
    return true;
  }

  // Weights of the second and third corner at a point of the plane.
  vec2 barycentric(const dvec3& point) const {
    const auto weight = [&](const dvec3& from, const dvec3& to) {
      return float(glm::dot(glm::cross(to - from, point - from), normal_) / (area_ * area_));
    };
    return {weight(corners_[2], corners_[0]), weight(corners_[0], corners_[1])};
  }

 private:
  static bool isBefore(const dvec3& a, const dvec3& b) {
    for (int i = 0; i < 3; ++i)
      if (a[i] != b[i]) return a[i] < b[i];
    return false;
  }

  vec3 sizes_;
  std::array<dvec3, 3> corners_;
  dvec3 normal_;
  double area_;  // twice the triangle's, the length of normal_
};

struct CoincidentSearch {
  const Accel& accel;
  const Ray& ray;
  const Hit& hit;
  const Surface& surface;
  uint32_t key;
  RayMask mask;
  void (*visit)(const Hit&, void*);
  void* visitor;
};

// The surface hides others up to rayOffset behind it along the normal: rays start there. By
// rounding errors a coincident triangle may also lie a little in front. The neighbours of the hit
// triangle in its mesh touch it at its edges, which does not count.
void testTriangle(const CoincidentSearch& s, uint32_t instanceIndex, uint32_t triangleIndex) {
  constexpr double kRoundings = 0.25, kNeighbour = 4;  // in offsets
  if (instanceIndex == s.hit.instance && triangleIndex == s.hit.triangle) return;
  if (!(s.accel.mask(instanceIndex) & s.mask)) return;
  const Scene& scene = s.accel.scene();
  const Instance& instance = scene.instances[instanceIndex];
  const CoincidentTriangle triangle(placedTriangle(scene, instance, triangleIndex, s.ray.time));
  const dvec3 normal(s.surface.geometricNormal), position(s.surface.position);
  if (triangle.isParallel(normal)) return;
  const double offset = s.surface.rayOffset, inFront = triangle.along(normal, position);
  if (inFront < -offset || inFront > kRoundings * std::max(offset, triangle.offset())) return;
  const bool isNeighbour = instanceIndex == s.hit.instance &&
                           isFromBehind(scene, instance, triangleIndex, -s.surface.geometricNormal,
                                        s.ray.time) != s.surface.frontFace;
  const dvec3 point = position + inFront * normal;
  if (!triangle.contains(point, isNeighbour ? kNeighbour * offset : 0)) return;
  const Hit other{instanceIndex, triangleIndex, triangle.barycentric(point), s.hit.distance};
  if (isCovered(scene, other, s.ray.direction, s.ray.time, s.key)) s.visit(other, s.visitor);
}

struct NearSearch {
  uint32_t instances;  // in the scene
  bool (*visit)(uint32_t, uint32_t, void*);
  void* visitor;
  bool goesOn = true;
};

// Those that are traced as instances, NearInstances finds.
bool visitPrimitive(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<NearSearch*>(arguments->userPtr);
  const RTCPointQueryContext& context = *arguments->context;
  if (context.instStackSize > 0 && context.instID[0] < search.instances) return false;
  search.goesOn = search.visit(arguments->geomID, arguments->primID, search.visitor);
  if (search.goesOn) return false;  // the radius stays
  arguments->query->radius = 0;
  return true;
}

}  // namespace

void Accel::visitNear(const vec3& point, float radius, float time, VisitTriangle visit,
                      void* visitor) const {
  NearSearch search{uint32_t(described_.instances.size()), visit, visitor};
  RTCPointQuery query{point.x, point.y, point.z, time, radius};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_, &query, &context, visitPrimitive, &search);
  if (nearInstances_ && search.goesOn) nearInstances_->search(point, radius, time, visit, visitor);
}

void Accel::visitCoincident(const Ray& ray, const Hit& hit, const Surface& surface, uint32_t key,
                            RayMask mask, VisitHit visit, void* visitor) const {
  constexpr float kReach = 4;  // in offsets
  const CoincidentSearch search{*this, ray, hit, surface, key, mask, visit, visitor};
  forEachNear(surface.position, kReach * surface.rayOffset, ray.time,
              [&](uint32_t instance, uint32_t triangle) {
                testTriangle(search, instance, triangle);
                return true;
              });
}

}  // namespace chromeball
