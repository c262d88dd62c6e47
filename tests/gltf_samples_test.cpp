// SPDX-License-Identifier: Apache-2.0
// Real and malformed glTF files, if the shared data is available.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "base/error.h"
#include "scene/bounds.h"
#include "scene/gltf/load_gltf.h"
#include "scene/mesh.h"
#include "shared_data.h"

namespace chromeball::gltf_samples_test {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> modelsBelow(const fs::path& folder) {
  std::vector<fs::path> models;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
      models.push_back(entry.path());
  std::sort(models.begin(), models.end());
  return models;
}

// Checks the invariants of a scene.
void expectValid(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    const size_t n = mesh.positions.size();
    EXPECT_FALSE(mesh.triangles.empty());
    for (const Triangle& t : mesh.triangles) ASSERT_LT(std::max({t.x, t.y, t.z}), n);
    for (const vec3& p : mesh.positions) ASSERT_TRUE(isFinite(p));
    EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == n);
    for (const vec3& normal : mesh.normals) ASSERT_NEAR(glm::length(normal), 1, 1e-5f);
    EXPECT_TRUE(mesh.colors.empty() || mesh.colors.size() == n);
    EXPECT_TRUE(mesh.tangents.empty() || mesh.tangents.size() == n);
    for (const vec4& t : mesh.tangents) {
      ASSERT_NEAR(glm::length(vec3(t)), 1, 1e-5f);
      ASSERT_EQ(std::fabs(t.w), 1);
    }
  }
  for (const Texture& texture : scene.textures)
    EXPECT_EQ(texture.grid->texels8.size() + texture.grid->texelsFloat.size(),
              size_t(texture.grid->width) * size_t(texture.grid->height));
  for (const Instance& instance : scene.instances) {
    ASSERT_LT(size_t(instance.mesh), scene.meshes.size());
    ASSERT_LT(size_t(instance.node), scene.nodeNames.size());
    ASSERT_LT(size_t(instance.material), scene.materials.size());
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    Material material = scene.materials[size_t(instance.material)];
    EXPECT_EQ(!mesh.tangents.empty(), tangentSpace(material).has_value());
    for (const TextureSlot* slot : textureSlots(material)) {
      if (!*slot) continue;
      ASSERT_LT(size_t(slot->texture), scene.textures.size());
      ASSERT_EQ(mesh.uvs.at(size_t(slot->uvSet)).size(), mesh.positions.size());
    }
  }
}

// Loads a valid sample model if it is available.
std::optional<Scene> sample(const std::string& relative) {
  const auto path = sharedData("gltf/" + relative);
  if (!path) return std::nullopt;
  return loadGltf(path->string(), {}, nullptr);
}

TEST(SlowGltfSamples, EveryGoodModelLoads) {
  const auto folder = sharedData("gltf");
  if (!folder) GTEST_SKIP() << "no sample models";
  for (const fs::path& model : modelsBelow(*folder)) {
    const std::string name = model.string();
    SCOPED_TRACE(name);
    try {
      expectValid(loadGltf(name, {}, nullptr));
    } catch (const InputError& e) {
      const std::string message = e.what();
      EXPECT_TRUE(message.starts_with(name + ": "));
      EXPECT_EQ(message.find('\n'), std::string::npos);
      const bool expected =
          name.find("assimp_gltf1") != std::string::npos ||
          name.find("assimp_specgloss") != std::string::npos ||
          name.ends_with("Compatibility_04.gltf") ||  // requires glTF 2.1
          name.ends_with("Compatibility_05.gltf");    // requires an unknown extension
      EXPECT_TRUE(expected) << message;
    }
  }
}

TEST(SlowGltfSamples, EveryMalformedModelIsRejectedInOneLineOrValid) {
  const auto folder = sharedData("bad");
  if (!folder) GTEST_SKIP() << "no hostile models";
  for (const fs::path& model : modelsBelow(*folder)) {
    SCOPED_TRACE(model.string());
    try {
      expectValid(loadGltf(model.string(), {}, nullptr));
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    }
  }
}

// Truncated models and models with a single byte changed do not crash.
TEST(SlowGltfSamples, DamagedBytesNeverCrash) {
  const auto path = sharedData("gltf/BoxTextured/glTF-Binary/BoxTextured.glb");
  if (!path) GTEST_SKIP() << "no sample models";
  std::ifstream stream(*path, std::ios::binary);
  const std::string good(std::istreambuf_iterator<char>(stream), {});
  const fs::path target = fs::temp_directory_path() / "chromeball-damaged.glb";
  for (size_t i = 0; i < 1000; ++i) {
    std::string bad = good;
    const size_t at = i * 2654435761u % bad.size();
    bad[at] = char(bad[at] ^ (1 << i % 8));
    if (i % 10 == 0) bad.resize(at);
    std::ofstream(target, std::ios::binary) << bad;
    try {
      expectValid(loadGltf(target.string(), {}, nullptr));
    } catch (const InputError&) {
    }
  }
  fs::remove(target);
}

TEST(GltfSamples, EveryEncodingOfTheBoxGivesTheSameScene) {
  const auto plain = sample("Box/glTF/Box.gltf");
  if (!plain) GTEST_SKIP() << "no sample models";
  for (const char* other : {"Box/glTF-Binary/Box.glb", "Box/glTF-Embedded/Box.gltf",
                            "BoxInterleaved/glTF/BoxInterleaved.gltf"}) {
    const auto scene = sample(other);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->triangleCount(), 12u);
    EXPECT_EQ(bounds(*scene).min, bounds(*plain).min);
    EXPECT_EQ(bounds(*scene).max, bounds(*plain).max);
  }
  const auto binary = sample("Box/glTF-Binary/Box.glb");
  EXPECT_EQ(binary->meshes[0].positions, plain->meshes[0].positions);
  EXPECT_EQ(binary->meshes[0].triangles, plain->meshes[0].triangles);
}

TEST(GltfSamples, EqualSpheresShareAMesh) {
  const auto scene =
      sample("MetalRoughSpheresNoTextures/glTF-Binary/MetalRoughSpheresNoTextures.glb");
  if (!scene) GTEST_SKIP() << "no sample models";
  EXPECT_EQ(scene->triangleCount(), 1040409u);
  EXPECT_EQ(scene->instances.size(), 123u);  // one per primitive
  EXPECT_LT(scene->meshes.size(), 30u);      // the 98 spheres share a mesh
}

TEST(GltfSamples, QuantisedDuckEqualsTheDuck) {
  const auto duck = sample("Duck/glTF/Duck.gltf"),
             quantised = sample("Duck/glTF-Quantized/Duck.gltf");
  if (!duck || !quantised) GTEST_SKIP() << "no sample models";
  EXPECT_EQ(duck->triangleCount(), quantised->triangleCount());
  const float tolerance = 1e-3f;
  EXPECT_NEAR(glm::distance(bounds(*duck).min, bounds(*quantised).min), 0, tolerance);
  EXPECT_NEAR(glm::distance(bounds(*duck).max, bounds(*quantised).max), 0, tolerance);
}

// The tangents in this model are from MikkTSpace; half of its cells are mirrored.
TEST(GltfSamples, ComputedTangentsAgreeWithMikkTSpace) {
  const auto scene = sample("NormalTangentMirrorTest/glTF/NormalTangentMirrorTest.gltf");
  if (!scene) GTEST_SKIP() << "no sample models";
  const Mesh& given = scene->meshes.at(0);
  Mesh computed = given;
  computed.tangents.clear();
  computeTangents(computed, given.uvs[0]);
  ASSERT_EQ(computed.triangles.size(), given.triangles.size());
  for (size_t i = 0; i < given.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const vec4& a = given.tangents[given.triangles[i][k]];
      const vec4& b = computed.tangents[computed.triangles[i][k]];
      ASSERT_EQ(a.w, b.w);
      ASSERT_GT(glm::dot(vec3(a), vec3(b)), 0.9999f);
    }
}

}  // namespace
}  // namespace chromeball::gltf_samples_test
