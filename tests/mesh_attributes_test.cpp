// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace chromeball::mesh_attributes_test {
namespace {

// A square in z = 0 of two triangles, front to +Z, with an upright texture: v points down.
Mesh square() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.normals.assign(4, vec3(0, 0, 1));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}
const std::vector<vec2> kUpright{{0, 1}, {1, 1}, {1, 0}, {0, 0}};

TEST(MeshAttributes, TangentRunsAlongUAndBitangentUpTheImage) {
  Mesh mesh = square();
  computeTangents(mesh, kUpright);
  ASSERT_EQ(mesh.tangents.size(), 4u);
  for (const vec4& t : mesh.tangents) {
    EXPECT_NEAR(glm::distance(vec3(t), vec3(1, 0, 0)), 0, 1e-6f);
    EXPECT_EQ(t.w, 1);  // cross(n, t) is +Y, which is up the image
  }
}

TEST(MeshAttributes, VerticesOnMirrorSeamsAreSplit) {
  // The texture is mirrored on the second triangle, along the diagonal 0-2.
  Mesh mesh = square();
  computeTangents(mesh, {{0, 1}, {1, 1}, {1, 0}, {1, 1}});
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.normals.size(), 6u);
  const auto signs = [&](size_t triangle) {
    vec3 w;
    for (int k = 0; k < 3; ++k) w[k] = mesh.tangents[mesh.triangles[triangle][k]].w;
    return w;
  };
  EXPECT_EQ(signs(0), vec3(1));
  EXPECT_EQ(signs(1), vec3(-1));
  const Triangle& t = mesh.triangles[1];
  EXPECT_EQ(mesh.positions[t.x], vec3(0, 0, 0));
  EXPECT_EQ(mesh.positions[t.y], vec3(1, 1, 0));
}

// A pose may turn a triangle over; the vertices of all poses are the same.
TEST(MeshAttributes, PosesAreSplitAlike) {
  for (const std::vector<vec2>& uv :
       {kUpright, std::vector<vec2>{{0, 1}, {1, 1}, {1, 0}, {1, 1}}}) {
    Mesh rest = square(), folded = square();
    folded.positions[3] = {1, 0.2f, 0};
    computeTangents(rest, uv);
    computeTangents(folded, uv);
    EXPECT_EQ(rest.triangles, folded.triangles);
    EXPECT_EQ(rest.positions.size(), folded.positions.size());
  }
}

TEST(MeshAttributes, DegenerateUvsGiveAPerpendicularTangent) {
  for (const vec2 uv : {vec2(0), vec2(NAN), vec2(INFINITY)}) {
    Mesh mesh = square();
    computeTangents(mesh, std::vector<vec2>(4, uv));
    for (const vec4& t : mesh.tangents) {
      EXPECT_NEAR(glm::length(vec3(t)), 1, 1e-6f);
      EXPECT_NEAR(t.z, 0, 1e-6f);
    }
  }
}

// Transforming the frame or the mesh gives the same, for a rotation, a reflection and a shear.
TEST(MeshAttributes, TransformsApplyToTheWholeFrame) {
  glm::dmat4 shear(1);
  shear[2][0] = 0.5;
  for (const glm::dmat4& m :
       {glm::rotate(glm::dmat4(1), 1.0, {1, 2, 3}), glm::scale(glm::dmat4(1), {-1, 2, 1}),
        glm::scale(shear, {3, -1, -2}), glm::scale(shear, {-1, -1, -1})}) {
    Mesh mesh = square();
    computeTangents(mesh, kUpright);
    transformMesh(mesh, m);
    const Triangle& t = mesh.triangles[0];
    const vec3 front = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                  mesh.positions[t.z] - mesh.positions[t.x]);
    const vec3 n = mesh.normals[0], tangent(mesh.tangents[0]);
    EXPECT_NEAR(glm::dot(glm::normalize(front), n), 1, 1e-5f);
    EXPECT_NEAR(glm::length(tangent), 1, 1e-6f);
    const vec3 bitangent = mesh.tangents[0].w * glm::cross(n, tangent);
    EXPECT_GT(glm::dot(bitangent, vec3(glm::dmat3(m) * glm::dvec3(0, 1, 0))), 0);
  }
}

TEST(MeshAttributes, FlatTrianglesDoNotShareVertices) {
  Mesh mesh = square();
  mesh.normals.clear();
  mesh.uvs = {{}, kUpright};
  makeFlat(mesh);
  EXPECT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.uvs[1].size(), 6u);
  EXPECT_TRUE(mesh.uvs[0].empty());
  for (const vec3& n : mesh.normals) EXPECT_EQ(n, vec3(0, 0, 1));
}

TEST(MeshAttributes, TinyNormalsKeepTheirDirection) {
  Mesh mesh = square();
  mesh.normals[0] = vec3(0, 1e-30f, 0);
  mesh.normals[1] = vec3(3e38f, 0, 0);
  repairNormals(mesh);
  EXPECT_EQ(mesh.normals[0], vec3(0, 1, 0));
  EXPECT_EQ(mesh.normals[1], vec3(1, 0, 0));
}

}  // namespace
}  // namespace chromeball::mesh_attributes_test
