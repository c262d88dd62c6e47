// SPDX-License-Identifier: Apache-2.0
#include "doric.h"

#include "flat.h"
#include "turned.h"

namespace chromeball::demo {

double radiusAt(const DoricColumn& column, double height) {
  const double t = height / column.shaft;
  return glm::mix(column.lowerRadius, column.upperRadius, t) + column.entasis * 4 * t * (1 - t);
}

Surface shaft(const DoricColumn& column) {
  constexpr int kStepsOfFlute = 7, kRows = 12;
  const auto point = [&](double u, double v) {
    const double across = 2 * (column.flutes * u - std::floor(column.flutes * u)) - 1;
    const double radius = radiusAt(column, v * column.shaft) * (1 - 0.07 * (1 - across * across));
    const double angle = 2 * kPiD * u;
    return dvec3(radius * std::cos(angle), v * column.shaft, -radius * std::sin(angle));
  };
  Surface surface = tessellate(column.flutes * kStepsOfFlute, kRows, point, Uvs::Parameters);
  for (vec2& uv : surface.uvs) uv.y = 1 - uv.y;  // drums' joints are drawn from the top down
  return surface;
}

Surface capital(const DoricColumn& column) {
  const double neck = column.upperRadius, bottom = column.shaft, top = column.height;
  const double abacus = 0.36, rim = bottom + 0.8 * (top - abacus - bottom), half = column.abacus;
  Surface surface = tessellateTurned(48, dvec3(0),
                                     {{0.93 * neck, bottom - 0.01},
                                      {neck, bottom},
                                      {neck + 0.01, bottom + 0.04},
                                      {neck, bottom + 0.05},
                                      {neck + 0.01, bottom + 0.09},
                                      {glm::mix(neck, half, 0.35), glm::mix(bottom, rim, 0.45)},
                                      {glm::mix(neck, half, 0.7), glm::mix(bottom, rim, 0.75)},
                                      {0.97 * half, rim},
                                      {0.99 * half, glm::mix(rim, top - abacus, 0.4)},
                                      {0.95 * half, top - abacus}});
  addClosedBox(surface, vec3(-half, top - abacus, -half), vec3(half, top, half), 6);
  return surface;
}

Surface triglyph(float width, float height) {
  constexpr float kDepth = 0.14f, kGroove = 0.11f;
  // Its cross-section from left to right, in sixths of the width: chamfer, bar, groove, bar, ...
  const vec2 section[] = {
      {0, 0.02f},     {0.5f, kDepth},        {1.5f, kDepth}, {2, kDepth - kGroove}, {2.5f, kDepth},
      {3.5f, kDepth}, {4, kDepth - kGroove}, {4.5f, kDepth}, {5.5f, kDepth},        {6, 0.02f}};
  Surface surface;
  const float unit = width / 6, cap = 0.16f;
  for (size_t i = 0; i + 1 < std::size(section); ++i) {
    const vec2 a = section[i], b = section[i + 1];
    const vec3 corner(a.x * unit - width / 2, 0, a.y);
    addQuad(surface, corner, {(b.x - a.x) * unit, 0, b.y - a.y}, {0, height - cap, 0}, 6);
  }
  addClosedBox(surface, {-width / 2, height - cap, 0}, {width / 2, height, kDepth + 0.02f}, 6);
  return surface;
}

}  // namespace chromeball::demo
