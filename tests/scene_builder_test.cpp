// SPDX-License-Identifier: Apache-2.0
// Scenes from memory: as sound as those from files, with errors that name the fault.
#include "scene/builder/scene_builder.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "base/error.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "test_scene.h"

namespace chromeball::scene_builder_test {
namespace {

using nlohmann::json;

// A bumpy grid of quads over [0, 1]^2 with one vertex that no triangle uses, and an image.
struct Arrays {
  static constexpr int kSide = 5, kTexels = 16;
  Mesh mesh;
  std::vector<uint8_t> texels;

  Arrays() {
    std::mt19937 random(3);
    const auto unit = [&] { return float(random() % 1000) / 1000; };
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const vec2 uv(float(x) / (kSide - 1), float(y) / (kSide - 1));
        mesh.positions.emplace_back(uv.x, uv.y, 0.1f * unit());
        mesh.normals.emplace_back(0.2f * unit(), 0.2f * unit(), 3);  // not unit
        mesh.colors.emplace_back(unit(), unit(), unit(), 1);
        if (mesh.uvs.empty()) mesh.uvs.resize(1);
        mesh.uvs[0].push_back(uv * 2.0f);
      }
    mesh.normals[7] = vec3(0);  // to be repaired
    mesh.positions.emplace_back(9, 9, 9);
    mesh.normals.emplace_back(0, 0, 1);
    mesh.colors.emplace_back(1);
    mesh.uvs[0].emplace_back(0, 0);
    for (uint32_t y = 0; y + 1 < kSide; ++y)
      for (uint32_t x = 0; x + 1 < kSide; ++x) {
        const uint32_t i = y * kSide + x;
        mesh.triangles.push_back({i, i + 1, i + kSide});
        mesh.triangles.push_back({i + 1, i + kSide + 1, i + kSide});
      }
    for (int i = 0; i < 4 * kTexels * kTexels; ++i) texels.push_back(uint8_t(random() % 256));
  }

  TexelGrid image() const {
    TexelGrid grid{kTexels, kTexels, {}, {}};
    for (size_t i = 0; i < texels.size(); i += 4)
      grid.texels8.push_back({texels[i], texels[i + 1], texels[i + 2], texels[i + 3]});
    return grid;
  }
};

template <class T>
std::vector<float> flat(const std::vector<T>& vectors) {
  std::vector<float> numbers;
  for (const T& v : vectors)
    for (int k = 0; k < T::length(); ++k) numbers.push_back(v[k]);
  return numbers;
}

Scene fromFile(const Arrays& arrays) {
  GltfWriter w;
  w.write("a.png", encodePng(Arrays::kTexels, Arrays::kTexels, 4, arrays.texels));
  w.root["images"] = {{{"uri", "a.png"}}};
  w.root["textures"] = {{{"source", 0}}};
  w.root["materials"] = {
      {{"name", "bumpy"},
       {"alphaMode", "BLEND"},
       {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorTexture", {{"index", 0}}}}},
       {"normalTexture", {{"index", 0}}}}};
  std::vector<uint16_t> indices;
  for (const Triangle& t : arrays.mesh.triangles)
    for (int k = 0; k < 3; ++k) indices.push_back(uint16_t(t[k]));
  const std::vector<float> colors = flat(arrays.mesh.colors);
  const int mesh = w.mesh(
      {{"attributes",
        {{"POSITION", w.vec3s(flat(arrays.mesh.positions))},
         {"NORMAL", w.vec3s(flat(arrays.mesh.normals))},
         {"TEXCOORD_0", w.vec2s(flat(arrays.mesh.uvs[0]))},
         {"COLOR_0", w.accessor(w.view(colors), kFloat, "VEC4", arrays.mesh.positions.size())}}},
       {"indices", w.indices(indices)},
       {"material", 0}});
  w.add("nodes", {{"mesh", mesh}});
  w.add("nodes", {{"mesh", mesh}, {"translation", {0, 0, 2}}, {"scale", {2, 3, 4}}});
  return w.load();
}

Scene fromMemory(const Arrays& arrays) {
  Scene scene;
  SceneBuilder builder(scene);
  const int image = builder.addImage(arrays.image());
  Material material;
  material.name = "bumpy";
  material.metallic = 0;
  material.alphaMode = AlphaMode::Blend;
  material.baseColorTexture = builder.addTexture(image, true);
  material.normalTexture = builder.addTexture(image, false);
  const int bumpy = builder.addMaterial(material), mesh = builder.addMesh(arrays.mesh, bumpy);
  builder.addInstance(mesh, bumpy, builder.addNode("a"), Transform{});
  builder.addInstance(mesh, bumpy, builder.addNode("b"),
                      Transform{glm::mat3(vec3(2, 0, 0), vec3(0, 3, 0), vec3(0, 0, 4)), {0, 0, 2}});
  return scene;
}

// The same meshes, mip levels and picture as through a file.
TEST(SceneBuilder, ArraysMakeTheSceneOfAFile) {
  const Arrays arrays;
  const Scene file = fromFile(arrays), memory = fromMemory(arrays);
  ASSERT_EQ(memory.meshes.size(), 1u);
  EXPECT_EQ(memory.meshes[0], file.meshes[0]);
  EXPECT_EQ(memory.meshes[0].positions.size(), size_t(Arrays::kSide * Arrays::kSide));
  EXPECT_EQ(memory.meshes[0].tangents.size(), memory.meshes[0].positions.size());
  const auto textureOf = [](const Scene& scene, TextureSlot Material::*slot) -> const Texture& {
    return scene.textures[size_t((scene.materials[0].*slot).texture)];
  };
  for (const auto slot : {&Material::baseColorTexture, &Material::normalTexture}) {
    const Texture &a = textureOf(memory, slot), &b = textureOf(file, slot);
    EXPECT_EQ(a.srgb, b.srgb);
    EXPECT_EQ(a.weightedByAlpha, b.weightedByAlpha);
    EXPECT_EQ(a.grid->texels8, b.grid->texels8);
    ASSERT_EQ(a.mipLevels->size(), b.mipLevels->size());
    for (size_t i = 0; i < a.mipLevels->size(); ++i)
      EXPECT_EQ((*a.mipLevels)[i].texels8, (*b.mipLevels)[i].texels8) << i;
  }
  const auto picture = [](const Scene& scene) {
    const Camera camera = Camera::lookAt({1, 1, 9}, {1, 1, 0}, {0, 1, 0}, 0.4f);
    const Probe probe(gradientProbe({32, 16}, Rgb(0.5f), {0.1, 0.2, 0.3}));
    return renderScene(scene, camera, probe, "importance", smallRender(24, 24, 16, 4)).film.mean();
  };
  EXPECT_EQ(picture(memory).texels, picture(file).texels);
}

TEST(SceneBuilder, VerticesWithoutTrianglesAreTakenInThrees) {
  Scene scene;
  SceneBuilder builder(scene);
  const int material = builder.addMaterial(lambert(Rgb(0.5f)));
  Mesh soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  builder.addMesh(soup, material);
  EXPECT_EQ(scene.meshes[0].triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
}

std::string errorOf(const std::function<void(SceneBuilder&)>& add) {
  Scene scene;
  SceneBuilder builder(scene);
  Material material = lambert(Rgb(0.5f));
  material.name = "grey";
  builder.addMaterial(material);
  builder.addNode("node");
  const auto counts = [&] {
    return std::tuple(scene.meshes.size(), scene.materials.size(), scene.textures.size(),
                      scene.grids.size(), scene.instances.size(), scene.cameras.size(),
                      scene.lights.size(), scene.suns.size(), scene.ambient.size(),
                      scene.nodeNames.size());
  };
  const auto before = counts();
  try {
    add(builder);
  } catch (const InputError& error) {
    EXPECT_EQ(counts(), before) << error.what();
    return error.what();
  }
  return "";
}

std::string meshError(const std::function<void(Mesh&)>& change) {
  return errorOf([&](SceneBuilder& builder) {
    Mesh mesh = Arrays().mesh;
    change(mesh);
    builder.addMesh(mesh, 0);
  });
}

TEST(SceneBuilder, NamesTheArrayAndIndexThatAreWrong) {
  EXPECT_EQ(meshError([](Mesh&) {}), "");
  EXPECT_EQ(meshError([](Mesh& m) { m.positions[12].y = NAN; }),
            "mesh 0: positions[12]: is not finite");
  EXPECT_EQ(meshError([](Mesh& m) { m.triangles[3].z = 26; }),
            "mesh 0: triangles[3]: there is no vertex 26 among 26");
  EXPECT_EQ(meshError([](Mesh& m) { m.normals.pop_back(); }),
            "mesh 0: normals: 25 elements for 26 vertices");
  EXPECT_EQ(meshError([](Mesh& m) { m.tangents.resize(3); }),
            "mesh 0: tangents: 3 elements for 26 vertices");
  EXPECT_EQ(meshError([](Mesh& m) { m.uvs[0][5].x = INFINITY; }),
            "mesh 0: uvs[0][5]: is not finite");
  EXPECT_EQ(meshError([](Mesh& m) { m.colors[1].z = -1; }), "mesh 0: colors[1]: is negative");
  EXPECT_EQ(meshError([](Mesh& m) { m.triangles.clear(); }),
            "mesh 0: positions: 26; without triangles their number must be a multiple of 3");
  EXPECT_EQ(errorOf([](SceneBuilder& b) { b.addMesh(Arrays().mesh, 1); }),
            "there is no material 1 among 1");
  EXPECT_EQ(errorOf([](SceneBuilder& b) { b.addInstance(0, 0, 0); }), "there is no mesh 0 among 0");
  EXPECT_EQ(errorOf([](SceneBuilder& b) { b.addNode("child", 5); }), "there is no node 5 among 1");
}

TEST(SceneBuilder, RefusesSharedMeshesThatWouldBeReadOutOfBounds) {
  const auto error = [](const std::function<void(Mesh&)>& change) {
    return errorOf([&](SceneBuilder& builder) {
      Mesh mesh = Arrays().mesh;
      change(mesh);
      builder.addMesh(std::make_shared<const Mesh>(mesh));
    });
  };
  EXPECT_EQ(error([](Mesh&) {}), "");
  EXPECT_EQ(error([](Mesh& m) { m.triangles[3].z = 500000000; }),
            "mesh 0: triangles[3]: there is no vertex 500000000 among 26");
  EXPECT_EQ(error([](Mesh& m) { m.normals.pop_back(); }),
            "mesh 0: normals: 25 elements for 26 vertices");
  EXPECT_EQ(errorOf([](SceneBuilder& b) { b.addMesh(MeshList::Shared()); }), "mesh 0: is null");
}

TEST(SceneBuilder, MissingCoordinatesOfATextureAreAnError) {
  Scene scene;
  SceneBuilder builder(scene);
  Material material = lambert(Rgb(0.5f));
  material.name = "bumpy";
  material.normalTexture = builder.addTexture(builder.addImage(Arrays().image()), false);
  material.normalTexture.uvSet = 1;
  const int bumpy = builder.addMaterial(material);
  try {
    builder.addMesh(Arrays().mesh, bumpy);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "mesh 0: uvs[1]: is missing, which the material \"bumpy\" uses");
  }
}

TEST(SceneBuilder, NamesTheNumberOfAMaterialThatIsWrong) {
  const auto error = [](const std::function<void(Material&)>& change) {
    return errorOf([&](SceneBuilder& builder) {
      Material material = lambert(Rgb(0.5f));
      material.name = "red";
      material.extended.emplace();
      change(material);
      builder.addMaterial(material);
    });
  };
  EXPECT_EQ(error([](Material&) {}), "");
  EXPECT_EQ(error([](Material& m) { m.roughness = 2; }),
            "material \"red\": roughness is 2; it must be 0 to 1");
  EXPECT_EQ(error([](Material& m) { m.emission.y = NAN; }),
            "material \"red\": emission is nan; it must be 0 to 3.40282e+38");
  EXPECT_EQ(error([](Material& m) { m.ior = 0.5f; }),
            "material \"red\": ior is 0.5; it must be 1 to 1e+06");
  EXPECT_EQ(error([](Material& m) { m.extended->filmIor = 0; }),
            "material \"red\": filmIor is 0; it must be 1 to 1000");
  EXPECT_EQ(error([](Material& m) { m.emissiveTexture.texture = 0; }),
            "material \"red\": there is no texture 0 among 0");
}

// As factors: a surface must not reflect more than it receives. Emission may be any light.
TEST(SceneBuilder, RefusesTexelsAboveOneButOfEmission) {
  const auto withTexture = [](TextureSlot Material::*slot) -> std::string {
    Scene scene;
    SceneBuilder builder(scene);
    Material material = lambert(Rgb(0.5f));
    material.name = "m";
    const int image = builder.addImage({2, 1, {}, {vec4(1), vec4(0.5f, 255, 0, 1)}});
    material.*slot = builder.addTexture(image, false);
    try {
      builder.addMaterial(material);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  for (const auto slot : {&Material::baseColorTexture, &Material::metallicRoughnessTexture})
    EXPECT_EQ(withTexture(slot),
              "material \"m\": texel 1, 0 of a texture exceeds 1, as only emission and the "
              "specular colour may");
  EXPECT_EQ(withTexture(&Material::emissiveTexture), "");
}

TEST(SceneBuilder, RefusesImagesCamerasAndLightsThatAreWrong) {
  EXPECT_EQ(errorOf([](SceneBuilder& b) {
              b.addImage({0, 4, {}, {}});
            }),
            "image: is 0 x 4; it must have a texel");
  EXPECT_EQ(errorOf([](SceneBuilder& b) {
              b.addImage({2, 2, std::vector<std::array<uint8_t, 4>>(3), {}});
            }),
            "image: 3 texels of 8 bits and 0 of floats, for 2 x 2");
  EXPECT_EQ(errorOf([](SceneBuilder& b) {
              TexelGrid image{2, 2, {}, std::vector<vec4>(4)};
              image.texelsFloat[3].x = NAN;
              b.addImage(image);
            }),
            "image: texel 1, 1 must be finite, and not negative");
  EXPECT_NE(errorOf([](SceneBuilder& b) {
              Camera camera;
              camera.fov = 4;
              b.addCamera(camera);
            }),
            "");
  EXPECT_NE(errorOf([](SceneBuilder& b) { b.addLight({.intensity = Rgb(-1)}); }), "");
  EXPECT_NE(errorOf([](SceneBuilder& b) { b.addLight({.direction = {0, 0, 3}}); }), "");
  for (const auto& [inner, outer] : {std::pair{NAN, 0.2f}, {0.3f, 0.2f}, {0.1f, 7.0f}})
    EXPECT_NE(errorOf([&](SceneBuilder& b) {
                PunctualLight spot{.kind = PunctualLight::Kind::Spot};
                spot.innerCone = inner, spot.outerCone = outer;
                b.addLight(spot);
              }),
              "");
  EXPECT_NE(errorOf([](SceneBuilder& b) { b.addSun({{{0, 1, 0}, {1, 1, 1}, 0}}); }), "");
  EXPECT_NE(errorOf([](SceneBuilder& b) { b.addAmbient({Rgb(NAN)}); }), "");
}

TEST(SceneBuilder, RefusesTransformsWithoutInverse) {
  Scene scene;
  SceneBuilder builder(scene);
  const int material = builder.addMaterial(lambert(Rgb(0.5f)));
  const int mesh = builder.addMesh(Arrays().mesh, material), node = builder.addNode("flat");
  EXPECT_THROW(builder.addInstance(mesh, material, node, Transform{glm::mat3(0), {}}), InputError);
  EXPECT_THROW(builder.addInstance(mesh, material, node, Transform{{}, {0, INFINITY, 0}}),
               InputError);
  EXPECT_TRUE(scene.instances.empty());
}

// Joining keeps everything: the second scene's suns and ambient light, its textures and parents.
TEST(SceneBuilder, JoinedScenesKeepAllLights) {
  const auto part = [](double side) {
    Scene scene;
    SceneBuilder builder(scene);
    builder.addNode("child", builder.addNode("parent"));
    builder.addSun({{{0, side, 0}, {1, 1, 1}, 1}});
    builder.addAmbient({Rgb(float(2 + side))});
    builder.addLight({.position = vec3(float(side)), .node = 1});
    return scene;
  };
  Scene scene = part(1);
  append(scene, part(-1));
  ASSERT_EQ(scene.suns.size(), 2u);
  EXPECT_EQ(scene.suns[1].sun.direction.y, -1);
  ASSERT_EQ(scene.ambient.size(), 2u);
  EXPECT_EQ(scene.ambient[1].radiance, Rgb(1));
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[1].node, 3);
  EXPECT_EQ(scene.nodeParents, (std::vector<int>{-1, 0, -1, 2}));
}

}  // namespace
}  // namespace chromeball::scene_builder_test
