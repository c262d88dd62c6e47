// SPDX-License-Identifier: Apache-2.0
#include "math/icosphere.h"

#include <array>

namespace chromeball {
namespace {

using glm::dvec3;
using Triangle = std::array<dvec3, 3>;

std::vector<Triangle> icosahedron() {
  // The corners of three golden rectangles at right angles; neighbours are 2 apart.
  const double golden = (1 + std::sqrt(5.0)) / 2;
  std::vector<dvec3> corners;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-golden, golden})
      corners.insert(corners.end(), {{0, a, b}, {a, b, 0}, {b, 0, a}});

  const auto neighbours = [](const dvec3& a, const dvec3& b) { return glm::distance(a, b) < 2.1; };
  std::vector<Triangle> faces;
  for (size_t i = 0; i < corners.size(); ++i)
    for (size_t j = i + 1; j < corners.size(); ++j)
      for (size_t k = j + 1; k < corners.size(); ++k)
        if (neighbours(corners[i], corners[j]) && neighbours(corners[j], corners[k]) &&
            neighbours(corners[k], corners[i]))
          faces.push_back({normalize(corners[i]), normalize(corners[j]), normalize(corners[k])});
  return faces;
}

std::array<Triangle, 4> quarters(const Triangle& face) {
  const auto& [a, b, c] = face;
  const dvec3 ab = normalize(a + b), bc = normalize(b + c), ca = normalize(c + a);
  return {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}};
}

std::vector<Triangle> subdivide(const std::vector<Triangle>& faces) {
  std::vector<Triangle> smaller;
  smaller.reserve(4 * faces.size());
  for (const Triangle& face : faces)
    for (const Triangle& quarter : quarters(face)) smaller.push_back(quarter);
  return smaller;
}

// The inner sides of the planes through the origin and the edges of a face: unit normals.
Triangle planesOf(const Triangle& face) {
  const auto& [a, b, c] = face;
  const double turn = dot(cross(a, b), c) < 0 ? -1 : 1;
  const auto plane = [&](const dvec3& from, const dvec3& to) {
    return turn * normalize(cross(from, to));
  };
  return {plane(a, b), plane(b, c), plane(c, a)};
}

// The face whose cone the direction is deepest inside.
int deepest(const std::vector<Triangle>& planes, const dvec3& direction) {
  int best = 0;
  double depth = -2;
  for (size_t i = 0; i < planes.size(); ++i) {
    const auto& [a, b, c] = planes[i];
    const double d = std::min({dot(a, direction), dot(b, direction), dot(c, direction)});
    if (d > depth) depth = d, best = int(i);
  }
  return best;
}

// The index in quarters() of the quarter that the direction goes through: a corner's, if it is
// beyond the opposite edge of the middle one, else the middle one.
int quarterAt(const std::array<Triangle, 4>& parts, const dvec3& direction) {
  const auto& [ab, bc, ca] = parts[3];
  const auto isBeyond = [&](const dvec3& from, const dvec3& to, const dvec3& corner) {
    const dvec3 plane = cross(from, to);
    return dot(plane, direction) * dot(plane, corner) > 0;
  };
  if (isBeyond(ca, ab, parts[0][0])) return 0;
  if (isBeyond(ab, bc, parts[1][1])) return 1;
  return isBeyond(bc, ca, parts[2][2]) ? 2 : 3;
}

}  // namespace

std::vector<vec3> icosphereNormals(int subdivisions) {
  std::vector<Triangle> faces = icosahedron();
  for (int i = 0; i < subdivisions; ++i) faces = subdivide(faces);
  std::vector<vec3> normals;
  normals.reserve(faces.size());
  for (const auto& [a, b, c] : faces) {
    const dvec3 normal = normalize(cross(b - a, c - a));
    normals.emplace_back(dot(normal, a) < 0 ? -normal : normal);
  }
  return normals;
}

int icosphereFace(const vec3& direction, int subdivisions) {
  static const std::vector<Triangle> kFaces = icosahedron();
  static const std::vector<Triangle> kPlanes = [] {
    std::vector<Triangle> planes;
    for (const Triangle& face : kFaces) planes.push_back(planesOf(face));
    return planes;
  }();
  const dvec3 d = normalize(dvec3(direction));
  int index = deepest(kPlanes, d);
  Triangle face = kFaces[size_t(index)];
  for (int i = 0; i < subdivisions; ++i) {
    const std::array<Triangle, 4> parts = quarters(face);
    const int part = quarterAt(parts, d);
    face = parts[size_t(part)];
    index = 4 * index + part;
  }
  return index;
}

}  // namespace chromeball
