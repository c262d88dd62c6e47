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

std::vector<Triangle> subdivide(const std::vector<Triangle>& faces) {
  std::vector<Triangle> smaller;
  smaller.reserve(4 * faces.size());
  for (const auto& [a, b, c] : faces) {
    const dvec3 ab = normalize(a + b), bc = normalize(b + c), ca = normalize(c + a);
    smaller.insert(smaller.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return smaller;
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

}  // namespace chromeball
