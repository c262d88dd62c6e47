// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/picture_lines.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "scene/camera_view.h"

namespace chromeball {
namespace {

using glm::dvec2, glm::dvec3;

// The part of a line inside a rectangle around the picture (Liang and Barsky 1984); false if there
// is none.
bool clip(dvec2& from, dvec2& to, const dvec2& min, const dvec2& max) {
  double begin = 0, end = 1;
  const dvec2 along = to - from;
  if (!std::isfinite(along.x + along.y)) return false;
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const double limit = side < 0 ? from[axis] - min[axis] : max[axis] - from[axis];
      const double speed = side * along[axis];
      if (speed == 0 && limit < 0) return false;
      if (speed > 0) end = std::min(end, limit / speed);
      if (speed < 0) begin = std::max(begin, limit / speed);
    }
  if (!(begin < end)) return false;
  to = from + end * along;
  from += begin * along;
  return true;
}

using Corner = std::tuple<float, float, float>;
Corner cornerAt(const vec3& p) { return {p.x, p.y, p.z}; }

// What is known of an edge while its triangles are visited.
struct Fold {
  vec3 from, to;
  dvec3 normal;  // of its first triangle
  int triangles = 0;
  bool bends = false;
};

void addCreases(const Scene& scene, const Instance& instance, std::vector<ModelEdge>& edges) {
  const double straight = std::cos(glm::radians(30.0));
  const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
  std::map<std::pair<Corner, Corner>, Fold> folds;
  for (const Triangle& triangle : mesh.triangles) {
    vec3 p[3];
    for (int i = 0; i < 3; ++i) p[i] = instance.point(mesh.positions[triangle[i]]);
    const dvec3 across = glm::cross(dvec3(p[1] - p[0]), dvec3(p[2] - p[0]));
    if (!(glm::length(across) > 0)) continue;
    const dvec3 normal = glm::normalize(across);
    for (int i = 0; i < 3; ++i) {
      const vec3 a = p[i], b = p[(i + 1) % 3];
      Fold& fold = folds[std::minmax({cornerAt(a), cornerAt(b)})];
      if (fold.triangles++ == 0)
        fold.from = a, fold.to = b, fold.normal = normal;
      else
        fold.bends |= std::abs(glm::dot(fold.normal, normal)) < straight;
    }
  }
  for (const auto& [key, fold] : folds)
    if (fold.triangles == 1 || fold.bends) edges.push_back({fold.from, fold.to});
}

}  // namespace

PictureLines::PictureLines(Image& picture)
    : picture_(picture), width_(std::max(1.2, std::hypot(picture.width, picture.height) / 1000)) {}

void PictureLines::line(dvec2 from, dvec2 to, const Rgb& color) {
  const dvec2 size(picture_.width, picture_.height);
  if (!clip(from, to, dvec2(-width_), size + width_)) return;
  const dvec2 along = to - from;
  const double length2 = glm::dot(along, along), reach = 0.5 * width_ + 1;
  const int axis = std::abs(along.x) > std::abs(along.y) ? 0 : 1;  // steps along the longer one
  const double slope = along[axis] != 0 ? along[1 - axis] / along[axis] : 0;
  const double across = reach * std::sqrt(1 + slope * slope);
  const auto bound = [&](double x, int i) { return int(std::clamp(x, 0.0, size[i])); };
  for (int step = bound(std::min(from[axis], to[axis]) - reach, axis);
       step < bound(std::max(from[axis], to[axis]) + reach + 1, axis); ++step) {
    const double middle = from[1 - axis] + slope * (step + 0.5 - from[axis]);
    for (int other = bound(middle - across, 1 - axis); other < bound(middle + across + 1, 1 - axis);
         ++other) {
      const int x = axis == 0 ? step : other, y = axis == 0 ? other : step;
      const dvec2 offset = dvec2(x + 0.5, y + 0.5) - from;
      const double t = length2 > 0 ? std::clamp(glm::dot(offset, along) / length2, 0.0, 1.0) : 0;
      const double distance = glm::length(offset - t * along);
      const float covered = float(std::clamp(0.5 * width_ + 0.5 - distance, 0.0, 1.0));
      picture_.setRgb(x, y, glm::mix(picture_.rgb(x, y), color, covered));
    }
  }
}

void PictureLines::cross(const dvec2& at, const Rgb& color) {
  const double size = markSize();
  line(at - dvec2(size), at + dvec2(size), color);
  line(at + dvec2(size, -size), at + dvec2(-size, size), color);
}

void PictureLines::circle(const dvec2& at, const Rgb& color) {
  constexpr int kSides = 24;
  const auto corner = [&](int i) {
    const double angle = 2 * kPiD * i / kSides;
    return at + markSize() * dvec2(std::cos(angle), std::sin(angle));
  };
  for (int i = 0; i < kSides; ++i) line(corner(i), corner(i + 1), color);
}

std::vector<ModelEdge> creases(const Scene& scene) {
  std::vector<ModelEdge> edges;
  for (const Instance& instance : scene.instances) addCreases(scene, instance, edges);
  return edges;
}

void drawEdges(std::span<const ModelEdge> edges, const Camera& camera, const Rgb& color,
               Image& picture) {
  const dvec2 size(picture.width, picture.height);
  const CameraView view(camera, size.x / size.y);
  PictureLines lines(picture);
  const int parts = camera.distortion ? 16 : 1;
  const dvec3 forward(-camera.back), position(camera.position);
  for (const ModelEdge& edge : edges) {
    dvec3 from(edge.from), to(edge.to);
    const double nearFrom = glm::dot(from - position, forward);
    const double nearTo = glm::dot(to - position, forward);
    const double closest = 1e-3 * std::max(nearFrom, nearTo);  // what is nearer is left out
    if (!(closest > 0)) continue;
    if (nearFrom < closest) from = glm::mix(from, to, (closest - nearFrom) / (nearTo - nearFrom));
    if (nearTo < closest) to = glm::mix(to, from, (closest - nearTo) / (nearFrom - nearTo));
    std::optional<CameraView::Point> last = view.at(from);
    for (int i = 1; i <= parts; ++i) {
      const auto next = view.at(glm::mix(from, to, double(i) / parts));
      if (last && next) lines.line(size * last->position, size * next->position, color);
      last = next;
    }
  }
}

}  // namespace chromeball
