// SPDX-License-Identifier: Apache-2.0
// Tangents for meshes without them. As in MikkTSpace, a vertex's tangent is the mean of dP/du over
// its triangles, each projected onto the plane of the vertex normal, normalised and weighted by the
// triangle's angle at the vertex; triangles of opposite handedness are not mixed. Unlike
// MikkTSpace, the indices of the file decide which triangles share a vertex: identical vertices
// with different indices are not merged, and triangles around a vertex are not grouped by shared
// edges.
#include <array>

#include "scene/mesh_attributes.h"

namespace chromeball {
namespace {

using glm::dvec2;
using glm::dvec3;

enum Handedness { kRight = 0, kLeft = 1, kUndefined = 2 };  // w = 1; w = -1; no area in UV space

dvec3 unitOrZero(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : dvec3(0);
}

double cornerAngle(const std::array<dvec3, 3>& p, int k) {
  const dvec3 a = unitOrZero(p[(k + 1) % 3] - p[k]), b = unitOrZero(p[(k + 2) % 3] - p[k]);
  return std::acos(std::fmin(std::fmax(glm::dot(a, b), -1.0), 1.0));
}

// A triangle's contribution to the tangents of its three corners.
struct Contribution {
  std::array<Handedness, 3> handedness{kUndefined, kUndefined, kUndefined};
  std::array<dvec3, 3> tangent{};
};

Contribution contributionOf(const Mesh& mesh, const std::vector<vec2>& uv, const Triangle& t) {
  const std::array<dvec3, 3> p{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
  const dvec2 d1 = dvec2(uv[t.y]) - dvec2(uv[t.x]), d2 = dvec2(uv[t.z]) - dvec2(uv[t.x]);
  const double area = d1.x * d2.y - d2.x * d1.y;  // twice the signed area in UV space
  Contribution c;
  if (!(std::fabs(area) > 0) || !std::isfinite(area)) return c;

  const dvec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
  const dvec3 alongU = (e1 * d2.y - e2 * d1.y) * (area < 0 ? -1.0 : 1.0);  // dP/du, any length
  const dvec3 front = glm::cross(e1, e2);
  for (int k = 0; k < 3; ++k) {
    const dvec3 n = mesh.normals[t[k]];
    const dvec3 projected = unitOrZero(alongU - n * glm::dot(n, alongU));
    if (projected == dvec3(0)) continue;
    c.tangent[k] = projected * cornerAngle(p, k);
    // A normal map's +Y points up in the image, against v.
    const bool rightHanded = (area < 0) == (glm::dot(front, n) >= 0);
    c.handedness[k] = rightHanded ? kRight : kLeft;
  }
  return c;
}

}  // namespace

void computeTangents(Mesh& mesh, const std::vector<vec2>& uv) {
  const size_t vertexCount = mesh.positions.size();
  std::vector<std::array<dvec3, 2>> sums(vertexCount, {dvec3(0), dvec3(0)});
  std::vector<std::array<bool, 2>> has(vertexCount, {false, false});
  std::vector<std::array<Handedness, 3>> handedness(mesh.triangles.size());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Contribution c = contributionOf(mesh, uv, t);
    handedness[i] = c.handedness;
    for (int k = 0; k < 3; ++k) {
      if (c.handedness[k] == kUndefined) continue;
      sums[t[k]][c.handedness[k]] += c.tangent[k];
      has[t[k]][c.handedness[k]] = true;
    }
  }

  // If a vertex has triangles of both kinds, the left-handed ones get a copy of the vertex.
  std::vector<uint32_t> source(vertexCount), leftCopy(vertexCount);
  for (uint32_t i = 0; i < vertexCount; ++i) source[i] = leftCopy[i] = i;
  for (uint32_t i = 0; i < vertexCount; ++i) {
    if (!has[i][kRight] || !has[i][kLeft]) continue;
    leftCopy[i] = uint32_t(source.size());
    source.push_back(i);
  }
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      uint32_t& vertex = mesh.triangles[i][k];
      if (handedness[i][size_t(k)] == kLeft) vertex = leftCopy[vertex];
    }
  gatherVertices(mesh, source);

  mesh.tangents.resize(source.size());
  for (uint32_t i = 0; i < source.size(); ++i) {
    const Handedness kind = i >= vertexCount || !has[i][kRight] ? kLeft : kRight;
    const bool known = has[source[i]][kind];
    mesh.tangents[i] = known
                           ? vec4(vec3(unitOrZero(sums[source[i]][kind])), kind == kRight ? 1 : -1)
                           : vec4(0, 0, 0, 1);
  }
  repairTangents(mesh);
}

}  // namespace chromeball
