// SPDX-License-Identifier: Apache-2.0
#include "flat.h"

#include <array>

namespace chromeball::demo {
namespace {

constexpr int kArchSegments = 16;

}  // namespace

void addPolygon(Surface& surface, std::span<const vec3> corners, float textureSize) {
  const vec3 normal =
      glm::normalize(glm::cross(corners[1] - corners[0], corners.back() - corners[0]));
  const auto first = uint32_t(surface.positions.size());
  for (const vec3& p : corners) {
    surface.positions.push_back(p);
    surface.normals.push_back(normal);
    surface.uvs.push_back(std::abs(normal.y) > 0.5f   ? vec2(p.x, p.z) / textureSize
                          : std::abs(normal.z) > 0.5f ? vec2(p.x, -p.y) / textureSize
                                                      : vec2(p.z, -p.y) / textureSize);
  }
  for (uint32_t i = 2; i < corners.size(); ++i)
    surface.triangles.push_back(first + glm::uvec3(0, i - 1, i));
}

void addPrism(Surface& surface, std::span<const vec2> section, vec2 z, float textureSize) {
  std::vector<vec3> front, back;
  for (size_t i = 0; i < section.size(); ++i) {
    const vec2 p = section[i], edge = section[(i + 1) % section.size()] - p;
    addQuad(surface, vec3(p, z.x), vec3(edge, 0), {0, 0, z.y - z.x}, textureSize);
    front.push_back(vec3(p, z.y));
    back.push_back(vec3(section[section.size() - 1 - i], z.x));
  }
  addPolygon(surface, front, textureSize);
  addPolygon(surface, back, textureSize);
}

void addQuad(Surface& surface, vec3 corner, vec3 a, vec3 b, float textureSize) {
  addPolygon(surface, std::array{corner, corner + a, corner + a + b, corner + b}, textureSize);
}

void addBox(Surface& s, vec3 low, vec3 high, float textureSize) {
  const vec3 size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  addQuad(s, {low.x, high.y, high.z}, x, -z, textureSize);
  addQuad(s, {low.x, low.y, high.z}, x, y, textureSize);
  addQuad(s, {high.x, low.y, low.z}, -x, y, textureSize);
  addQuad(s, {high.x, low.y, high.z}, -z, y, textureSize);
  addQuad(s, low, z, y, textureSize);
}

void addClosedBox(Surface& s, vec3 low, vec3 high, float textureSize) {
  const vec3 size = high - low;
  addBox(s, low, high, textureSize);
  addQuad(s, low, {size.x, 0, 0}, {0, 0, size.z}, textureSize);
}

void addWall(Surface& surface, const Wall& wall, const Opening& opening, float textureSize) {
  const float width = glm::length(wall.along), middle = width / 2, half = opening.halfWidth;
  const vec3 along = wall.along / width, up(0, 1, 0), back = -glm::cross(along, up);
  const auto at = [&](float s, float y, float depth) {
    return wall.corner + s * along + y * up + depth * back;
  };
  // A rectangle or trapezium between two verticals, on front and back.
  const auto panel = [&](vec2 s, vec2 low, vec2 high) {
    addPolygon(
        surface,
        std::array{at(s.x, low.x, 0), at(s.y, low.y, 0), at(s.y, high.y, 0), at(s.x, high.x, 0)},
        textureSize);
    const float t = wall.thickness;
    addPolygon(
        surface,
        std::array{at(s.y, low.y, t), at(s.x, low.x, t), at(s.x, high.x, t), at(s.y, high.y, t)},
        textureSize);
  };
  // A face within the opening, from one point of its edge to the next, counter-clockwise.
  const auto reveal = [&](vec2 from, vec2 to) {
    const float t = wall.thickness;
    addPolygon(surface,
               std::array{at(from.x, from.y, 0), at(to.x, to.y, 0), at(to.x, to.y, t),
                          at(from.x, from.y, t)},
               textureSize);
  };
  const vec2 left(middle - half, opening.spring), right(middle + half, opening.spring);
  const auto whole = [&](float s0, float s1) { panel({s0, s1}, vec2(0), vec2(wall.height)); };
  whole(0, left.x);
  whole(right.x, width);
  if (opening.sill > 0) {
    panel({left.x, right.x}, vec2(0), vec2(opening.sill));
    reveal({left.x, opening.sill}, {right.x, opening.sill});
  }
  if (opening.spring > opening.sill) {
    reveal({right.x, opening.sill}, right);
    reveal(left, {left.x, opening.sill});
  }
  vec2 last = right;
  for (int i = 1; i <= kArchSegments; ++i) {
    const float angle = kPi * float(i) / kArchSegments;
    const vec2 next = i == kArchSegments ? left
                                         : vec2(middle + half * std::cos(angle),
                                                opening.spring + half * std::sin(angle));
    panel({next.x, last.x}, {next.y, last.y}, vec2(wall.height));
    reveal(last, next);
    last = next;
  }
}

}  // namespace chromeball::demo
