// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"

#include <algorithm>
#include <cmath>

namespace chromeball::demo {
namespace {

constexpr double kTau = 2 * kPiD;

// Turns p about the vertical and moves it to the centre.
dvec3 placed(dvec3 center, double turn, dvec3 p) {
  return center + dvec3(std::cos(turn) * p.x + std::sin(turn) * p.z, p.y,
                        std::cos(turn) * p.z - std::sin(turn) * p.x);
}

}  // namespace

Surface tessellate(int columns, int rows, const Parametrisation& point, Uvs uvs) {
  constexpr double kStep = 1e-5;
  Surface surface;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double u = double(i) / columns, v = double(j) / rows;
      const double w = std::clamp(v, 1e-4, 1 - 1e-4);  // a pole has no dp/du
      const dvec3 du = point(u + kStep, w) - point(u - kStep, w);
      const dvec3 dv = point(u, w + kStep) - point(u, w - kStep);
      const vec3 p(point(u, v));
      surface.positions.push_back(p);
      surface.normals.push_back(vec3(glm::normalize(glm::cross(du, dv))));
      surface.uvs.push_back(
          uvs == Uvs::Parameters ? vec2(u, v) : vec2(p.x, p.z) / float(2 * kTableRadius) + 0.5f);
    }
  const auto add = [&](int a, int b, int c) {
    // In double precision: with FMA, the cross product of equal vectors is not 0.
    const dvec3 corner(surface.positions[a]);
    const dvec3 right = dvec3(surface.positions[b]) - corner;
    const dvec3 up = dvec3(surface.positions[c]) - corner;
    if (glm::length(glm::cross(right, up)) > 1e-10)
      surface.triangles.push_back(glm::uvec3(a, b, c));
  };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, c = b + columns + 1, d = c - 1;
      add(a, b, c);
      add(a, c, d);
    }
  return surface;
}

void append(Surface& surface, const Surface& more) {
  const auto first = uint32_t(surface.positions.size());
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(surface.positions, more.positions);
  add(surface.normals, more.normals);
  add(surface.uvs, more.uvs);
  for (const glm::uvec3& triangle : more.triangles) surface.triangles.push_back(triangle + first);
}

Parametrisation lathe(dvec3 center, const std::function<dvec2(double v)>& profile) {
  return [=](double u, double v) {
    const dvec2 p = profile(v);
    return center + dvec3(p.x * std::cos(kTau * u), p.y, -p.x * std::sin(kTau * u));
  };
}

Parametrisation patch(dvec3 corner, dvec3 right, dvec3 up) {
  return [=](double u, double v) { return corner + u * right + v * up; };
}

Parametrisation ball(dvec3 center, double radius) {
  return lathe(center, [=](double v) {
    const double angle = kPiD * (v - 0.5);
    return radius * dvec2(std::cos(angle), std::sin(angle));
  });
}

Parametrisation tableTop() {
  constexpr double kHalfHeight = 0.07, kPower = 16;
  return lathe({0, -kHalfHeight, 0}, [](double v) {
    const double c = std::cos(kPiD * (v - 0.5)), s = std::sin(kPiD * (v - 0.5));
    const double size =
        std::pow(std::pow(std::abs(c), kPower) + std::pow(std::abs(s), kPower), -1 / kPower);
    return size * dvec2(kTableRadius * c, kHalfHeight * s);
  });
}

// The profile is Catmull and Rom's curve through the points, less the first and last.
Parametrisation vase(dvec3 foot) {
  static const std::vector<dvec2> kPoints = {
      {-0.3, 0.0},  {0.0, 0.0},    {0.27, 0.0},   {0.31, 0.03},  {0.36, 0.2},   {0.46, 0.48},
      {0.43, 0.78}, {0.25, 1.06},  {0.165, 1.22}, {0.19, 1.38},  {0.262, 1.49}, {0.255, 1.515},
      {0.23, 1.5},  {0.165, 1.38}, {0.14, 1.22},  {0.225, 1.05}, {0.38, 0.77},  {0.4, 0.5},
      {0.2, 0.08},  {0.0, 0.06},   {-0.2, 0.08}};
  return lathe(foot, [](double v) {
    const double s = v * double(kPoints.size() - 3);
    const int i = std::clamp(int(s), 0, int(kPoints.size()) - 4);
    const double t = s - i;
    const dvec2 a = kPoints[i], b = kPoints[i + 1], c = kPoints[i + 2], d = kPoints[i + 3];
    return 0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * t * t +
                  (3.0 * b - 3.0 * c + d - a) * t * t * t);
  });
}

Parametrisation knot(dvec3 center, double size, double tube, double turn) {
  const auto curve = [=](double t) {
    const double r = 1 + 0.42 * std::cos(3 * t);
    return size * dvec3(r * std::cos(2 * t), r * std::sin(2 * t), 0.42 * std::sin(3 * t));
  };
  return [=](double u, double v) {
    const double t = kTau * u;
    const dvec3 here = curve(t), next = curve(t + 1e-3), tangent = glm::normalize(next - here);
    const dvec3 side = glm::normalize(glm::cross(tangent, next + here));
    const dvec3 out = glm::cross(side, tangent);
    const dvec3 p = here + tube * (std::cos(kTau * v) * out - std::sin(kTau * v) * side);
    return placed(center, turn, p);
  };
}

Parametrisation softCube(dvec3 center, double radius, double turn) {
  const Parametrisation sphere = ball(dvec3(0), 1);
  return [=](double u, double v) {
    const dvec3 d = sphere(u, v), p6(std::pow(d.x, 6), std::pow(d.y, 6), std::pow(d.z, 6));
    const dvec3 p = d * radius * std::pow(p6.x + p6.y + p6.z, -1.0 / 6);
    return placed(center, turn, p);
  };
}

}  // namespace chromeball::demo
