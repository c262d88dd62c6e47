// SPDX-License-Identifier: Apache-2.0
// glTF materials, textures and images.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "gltf_writer.h"
#include "scene/gltf/load_gltf.h"
#include "scene/surface.h"

namespace chromeball::gltf_material_test {
namespace {

using nlohmann::json;

const std::vector<float> kUv = {0, 0, 1, 0, 0, 1};

// A textured triangle with the given material.
Scene loadWith(GltfWriter& w, const json& material,
               const json& sampler = {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}) {
  w.write("a.png", kPng);
  w.root["images"] = {{{"uri", "a.png"}}};
  w.root["textures"] = {{{"source", 0}}, {{"source", 0}, {"sampler", 0}}};
  w.root["samplers"] = {sampler};
  w.root["materials"] = {material};
  addTriangle(w, {{"material", 0},
                  {"attributes",
                   {{"TEXCOORD_0", w.vec2s(kUv)},
                    {"TEXCOORD_1", w.vec2s({5, 5, 6, 5, 5, 6})},
                    {"NORMAL", w.vec3s({0, 0, 1, 0, 0, 1, 0, 0, 1})}}}});
  return w.load();
}

// KHR_materials_pbrSpecularGlossiness: c_diff = diffuse (1 - max(specular)), F0 = specular,
// alpha = (1 - glossiness)^2; with the texture's colour (sRGB) and alpha at its first texel, red.
TEST(GltfMaterial, SpecularGlossiness) {
  for (const bool textured : {false, true}) {
    GltfWriter w;
    json e = {{"diffuseFactor", {0.8, 0.4, 0.2, 0.5}},
              {"specularFactor", {0.5, 0.25, 0.125}},
              {"glossinessFactor", 0.75}};
    if (textured) e["diffuseTexture"] = e["specularGlossinessTexture"] = {{"index", 1}};
    const Scene scene = loadWith(w, {{"alphaMode", "BLEND"},
                                     {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 1, 1}}}},
                                     {"extensions", {{"KHR_materials_pbrSpecularGlossiness", e}}}});
    EXPECT_EQ(scene.materials.at(0).baseColor.w, 0.5f);
    const Instance& instance = scene.instances.at(0);
    const MaterialPoint p =
        materialAt(scene, surfaceAt(scene, instance, 0, {0.01f, 0.01f}, {0, 0, 1}));
    EXPECT_NEAR(p.baseColor.x, 0.8 * (1 - 0.5), 1e-6);
    EXPECT_NEAR(p.baseColor.y, textured ? 0 : 0.4 * (1 - 0.5), 1e-6);
    EXPECT_NEAR(p.dielectricF0.x, 0.5, 1e-6);
    EXPECT_NEAR(p.dielectricF0.y, textured ? 0 : 0.25, 1e-6);
    EXPECT_EQ(p.dielectricF90, 1);
    EXPECT_EQ(p.metallic, 0);
    EXPECT_NEAR(p.roughness, 0.25, 1e-6);
  }
}

TEST(GltfMaterial, DefaultMaterial) {
  GltfWriter w;
  addTriangle(w);
  const Scene scene = w.load();
  ASSERT_EQ(scene.materials.size(), 1u);
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.baseColor, vec4(1));
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.ior, 1.5f);
  EXPECT_FALSE(m.baseColorTexture);
}

TEST(GltfMaterial, FactorsAndExtensions) {
  GltfWriter w;
  const Material m =
      loadWith(w, {{"name", "paint"},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", {.1, .2, .3, .4}},
                     {"metallicFactor", .5},
                     {"roughnessFactor", .25}}},
                   {"emissiveFactor", {1, .5, 0}},
                   {"alphaMode", "MASK"},
                   {"alphaCutoff", .75},
                   {"doubleSided", true},
                   {"extensions",
                    {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                     {"KHR_materials_ior", {{"ior", 1.33}}},
                     {"KHR_materials_specular",
                      {{"specularFactor", .5}, {"specularColorFactor", {1, 2, .5}}}}}}})
          .materials[0];
  EXPECT_EQ(m.name, "paint");
  EXPECT_EQ(m.baseColor, vec4(.1f, .2f, .3f, .4f));
  EXPECT_EQ(m.metallic, .5f);
  EXPECT_EQ(m.roughness, .25f);
  EXPECT_EQ(m.emission, Rgb(8, 4, 0));
  EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
  EXPECT_EQ(m.alphaCutoff, .75f);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.ior, 1.33f);
  EXPECT_EQ(m.specular, .5f);
  EXPECT_EQ(m.specularColor, Rgb(1, 2, .5f));
}

TEST(GltfMaterial, ExtendedMaterials) {
  GltfWriter w;
  const Scene scene = loadWith(
      w, {{"extensions",
           {{"KHR_materials_transmission",
             {{"transmissionFactor", .75}, {"transmissionTexture", {{"index", 0}}}}},
            {"KHR_materials_volume",
             {{"thicknessFactor", 2},
              {"attenuationDistance", .5},
              {"attenuationColor", {.25, .5, 1}}}},
            {"KHR_materials_dispersion", {{"dispersion", .3}}},
            {"KHR_materials_clearcoat",
             {{"clearcoatFactor", .5},
              {"clearcoatRoughnessFactor", .25},
              {"clearcoatNormalTexture", {{"index", 0}, {"scale", 2}}}}},
            {"KHR_materials_sheen",
             {{"sheenColorFactor", {.1, .2, .3}}, {"sheenRoughnessFactor", .4}}},
            {"KHR_materials_anisotropy", {{"anisotropyStrength", .6}, {"anisotropyRotation", 1.5}}},
            {"KHR_materials_iridescence",
             {{"iridescenceFactor", .9},
              {"iridescenceIor", 1.7},
              {"iridescenceThicknessMaximum", 500}}}}}});
  ASSERT_TRUE(scene.materials[0].extended);
  const ExtendedMaterial& m = *scene.materials[0].extended;
  EXPECT_EQ(m.transmission, .75f);
  EXPECT_TRUE(m.transmissionTexture);
  EXPECT_FALSE(m.thinWalled);
  for (int c = 0; c < 3; ++c)  // half the distance transmits the square root
    EXPECT_NEAR(std::exp(-m.attenuation[c] * 0.25f), std::sqrt(.25f * float(1 << c)), 1e-5f);
  EXPECT_EQ(m.dispersion, .3f);
  EXPECT_EQ(m.clearcoat, .5f);
  EXPECT_EQ(m.clearcoatRoughness, .25f);
  EXPECT_EQ(m.clearcoatNormalScale, 2);
  EXPECT_EQ(m.sheenColor, Rgb(.1f, .2f, .3f));
  EXPECT_EQ(m.sheenRoughness, .4f);
  EXPECT_EQ(m.anisotropy, .6f);
  EXPECT_EQ(m.anisotropyRotation, 1.5f);
  EXPECT_EQ(m.iridescence, .9f);
  EXPECT_EQ(m.filmIor, 1.7f);
  EXPECT_EQ(m.filmMinThickness, 100);
  EXPECT_EQ(m.filmMaxThickness, 500);
  EXPECT_EQ(scene.meshes[0].tangents.size(), 3u);  // for the coat's normal map
}

TEST(GltfMaterial, VariantsChooseMaterials) {
  GltfWriter w;
  w.root["extensions"] = {
      {"KHR_materials_variants", {{"variants", {{{"name", "day"}}, {{"name", "night"}}}}}}};
  w.root["materials"] = {{{"name", "own"}}, {{"name", "dark"}}};
  const json mapping = {{"mappings", {{{"material", 1}, {"variants", {1}}}}}};
  addTriangle(w, {{"material", 0}, {"extensions", {{"KHR_materials_variants", mapping}}}});
  const std::string path = w.save();
  const auto material = [&](const GltfChoice& choice) {
    return loadGltf(path, {}, nullptr, choice).materials.at(0).name;
  };
  EXPECT_EQ(material({}), "own");
  EXPECT_EQ(material({.animation = {}, .variant = VariantChoice{"night", "--variant"}}), "dark");
  EXPECT_EQ(material({.animation = {}, .variant = VariantChoice{"day", "--variant"}}), "own");
  try {
    material({.animation = {}, .variant = VariantChoice{"nihgt", "--variant"}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()),
              path + ": has no variant `nihgt` (--variant); did you mean `night`?");
  }
}

TEST(GltfMaterial, DanglingVariantsGiveAWarning) {
  const auto warnings = [](const json& mapping, const char* variant) {
    GltfWriter w;
    w.root["extensions"] = {
        {"KHR_materials_variants", {{"variants", {{{"name", "day"}}, {{"name", "night"}}}}}}};
    w.root["extensionsUsed"] = {"KHR_materials_variants"};
    w.root["materials"] = {{{"name", "own"}}, {{"name", "dark"}}};
    const json mappings = {{"mappings", {mapping}}};
    addTriangle(w, {{"material", 0}, {"extensions", {{"KHR_materials_variants", mappings}}}});
    std::string messages;
    loadGltf(w.save(), {}, [&](const std::string& line) { messages += line + "\n"; },
             {.animation = {}, .variant = VariantChoice{variant, "--variant"}});
    return messages;
  };
  const auto holds = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_EQ(warnings({{"material", 1}, {"variants", {0, 1}}}, "day"), "");
  EXPECT_TRUE(holds(warnings({{"material", 1}, {"variants", {0, 5}}}, "day"),
                    "variants[5], which does not exist (2 in the file)"));
  EXPECT_TRUE(holds(warnings({{"material", 7}, {"variants", {0}}}, "day"),
                    "materials[7], which does not exist (2 in the file)"));
  EXPECT_TRUE(holds(warnings({{"material", 1}, {"variants", {0}}}, "night"),
                    "variant `night` has no effect"));
}

TEST(GltfMaterial, ExtensionsWithoutEffectAreDropped) {
  GltfWriter w;
  const Scene scene = loadWith(w, {{"extensions",
                                    {{"KHR_materials_transmission", {{"transmissionFactor", 0}}},
                                     {"KHR_materials_clearcoat", json::object()},
                                     {"KHR_materials_volume", {{"thicknessFactor", 1}}}}}});
  EXPECT_FALSE(scene.materials[0].extended);
}

TEST(GltfMaterial, MediaScaleWithTheModel) {
  GltfWriter w;
  loadWith(w, {{"extensions",
                {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                 {"KHR_materials_volume",
                  {{"thicknessFactor", 1},
                   {"attenuationDistance", 1},
                   {"attenuationColor", {.5, .5, .5}}}}}}});
  const Scene scene = w.load({mat3(4), vec3(0)});
  EXPECT_NEAR(scene.materials[0].extended->attenuation.x, std::log(2) / 4, 1e-6);
}

TEST(GltfMaterial, OneImageCanBeUsedAsSrgbAndLinear) {
  GltfWriter w;
  const Scene scene = loadWith(
      w, {{"pbrMetallicRoughness",
           {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 0}}}}}});
  EXPECT_EQ(scene.grids.size(), 1u);
  ASSERT_EQ(scene.textures.size(), 2u);
  const Material& m = scene.materials[0];
  const Texture& color = scene.textures[size_t(m.baseColorTexture.texture)];
  const Texture& linear = scene.textures[size_t(m.metallicRoughnessTexture.texture)];
  const vec2 right{0.75f, 0.5f};
  EXPECT_NEAR(color.lookup(right).y, std::pow((128 / 255. + 0.055) / 1.055, 2.4), 1e-6);
  EXPECT_NEAR(linear.lookup(right).y, 128 / 255., 1e-6);
  EXPECT_EQ(linear.lookup(right).w, 1);
  EXPECT_EQ(linear.wrapS, Wrap::Repeat);
}

TEST(GltfMaterial, SamplersAndTransforms) {
  GltfWriter w;
  const Scene scene = loadWith(w, {{"emissiveFactor", {1, 1, 1}},
                                   {"emissiveTexture",
                                    {{"index", 1},
                                     {"extensions",
                                      {{"KHR_texture_transform",
                                        {{"offset", {10, 20}},
                                         {"rotation", M_PI / 2},
                                         {"scale", {2, 3}},
                                         {"texCoord", 1}}}}}}}});
  const TextureSlot& slot = scene.materials[0].emissiveTexture;
  EXPECT_EQ(slot.uvSet, 1);
  // Scale, then a quarter turn counter-clockwise as seen (v points down), then the offset.
  const vec2 u = slot.transform({1, 0}), v = slot.transform({0, 1});
  EXPECT_NEAR(glm::distance(u, vec2(10, 18)), 0, 1e-5f);
  EXPECT_NEAR(glm::distance(v, vec2(13, 20)), 0, 1e-5f);
  const Texture& texture = scene.textures[size_t(slot.texture)];
  EXPECT_EQ(texture.wrapS, Wrap::ClampToEdge);
  EXPECT_EQ(texture.wrapT, Wrap::MirroredRepeat);
  EXPECT_EQ(texture.filter, Filter::Nearest);
  EXPECT_TRUE(texture.srgb);
  // Only the UV set that the material uses is kept.
  const Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.uvs.size(), 2u);
  EXPECT_TRUE(mesh.uvs[0].empty());
  EXPECT_EQ(mesh.uvs[1][1], vec2(6, 5));
}

TEST(GltfMaterial, UnlitKeepsOnlyItsColour) {
  GltfWriter w;
  const Scene scene = loadWith(w, {{"normalTexture", {{"index", 0}}},
                                   {"emissiveFactor", {1, 1, 1}},
                                   {"extensions", {{"KHR_materials_unlit", json::object()}}}});
  EXPECT_TRUE(scene.materials[0].unlit);
  EXPECT_TRUE(isBlack(scene.materials[0].emission));
  EXPECT_TRUE(scene.textures.empty());
}

TEST(GltfMaterial, TangentsOnlyForNormalMaps) {
  GltfWriter plain;
  EXPECT_TRUE(loadWith(plain, {{"name", "plain"}}).meshes[0].tangents.empty());
  GltfWriter mapped;
  const Mesh mesh = loadWith(mapped, {{"normalTexture", {{"index", 0}}}}).meshes[0];
  ASSERT_EQ(mesh.tangents.size(), 3u);
  // v points down in the image and up on the triangle, so the map's up is the triangle's down.
  for (const vec4& t : mesh.tangents) EXPECT_EQ(t, vec4(1, 0, 0, -1));
}

TEST(GltfMaterial, UnknownSamplersAreRejected) {
  const auto errorOf = [](const json& sampler) {
    GltfWriter w;
    try {
      loadWith(w, {{"normalTexture", {{"index", 1}}}}, sampler);
    } catch (const InputError& e) {
      return std::string(e.what()).substr((w.folder() / "model.gltf").string().size() + 2);
    }
    return std::string();
  };
  EXPECT_EQ(errorOf(json::object()), "");
  EXPECT_EQ(errorOf({{"wrapS", 10497}, {"wrapT", 33648}, {"magFilter", 9729}}), "");
  for (const char* wrap : {"wrapS", "wrapT"})  // 10496: GL_CLAMP
    EXPECT_EQ(errorOf({{wrap, 10496}}), std::string("samplers[0].") + wrap +
                                            ": 10496 is not 10497 (repeat), 33071 (clamp to edge) "
                                            "or 33648 (mirrored repeat)");
  EXPECT_EQ(errorOf({{"magFilter", 9987}}),  // of minFilter
            "samplers[0].magFilter: 9987 is not 9728 (nearest) or 9729 (linear)");
}

TEST(GltfMaterial, InvalidNumbersAreRejectedOrClamped) {
  const auto errorMessage = [](const json& material) {
    GltfWriter w;
    try {
      loadWith(w, material);
    } catch (const InputError& e) {
      return std::string(e.what()).substr((w.folder() / "model.gltf").string().size() + 2);
    }
    return std::string();
  };
  EXPECT_EQ(errorMessage({{"alphaMode", "GLASS"}}),
            "materials[0].alphaMode: \"GLASS\" is not OPAQUE, MASK or BLEND");
  EXPECT_EQ(errorMessage({{"normalTexture", {{"index", 9}}}}),
            "materials[0].normalTexture: textures[9] does not exist (2 in the file)");
  EXPECT_EQ(errorMessage({{"normalTexture", {{"index", 0}, {"texCoord", 1000000000}}}}),
            "materials[0].normalTexture: texCoord 1000000000 is not in the range 0 to 15");
  GltfWriter w;
  const Scene scene = loadWith(w, {{"pbrMetallicRoughness", {{"roughnessFactor", 1.5}}}});
  EXPECT_EQ(scene.materials[0].roughness, 1);
  EXPECT_EQ(w.warnings.size(), 1u);
  // 0 and 1 upwards are valid.
  for (const double ior : {0.0, 0.5, 0.99, 1.0, 1.33}) {
    GltfWriter model;
    const Scene read = loadWith(model, {{"extensions", {{"KHR_materials_ior", {{"ior", ior}}}}}});
    const bool isClamped = ior > 0 && ior < 1;
    EXPECT_EQ(read.materials[0].ior, isClamped ? 1 : float(ior));
    EXPECT_EQ(model.warnings.size(), isClamped ? 1u : 0u) << ior;
  }
}

TEST(GltfMaterial, TexturesByExtension) {
  GltfWriter w;
  loadWith(w, {{"normalTexture", {{"index", 0}}}});
  json& texture = w.root["textures"][0];
  texture = {{"source", 99}, {"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
  EXPECT_EQ(w.load().textures.at(0).grid->width, 2);
  texture = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  EXPECT_NE(w.errorMessage().find("textures[0]: has only a KTX2 image"), std::string::npos);
  texture["source"] = 0;  // the fallback for readers without KTX2
  EXPECT_EQ(w.errorMessage(), "");
}

TEST(GltfMaterial, RejectsInvalidImages) {
  const auto errorMessage = [](const std::vector<uint8_t>& image) {
    GltfWriter w;
    loadWith(w, {{"normalTexture", {{"index", 0}}}});
    w.write("a.png", image);
    return w.errorMessage();
  };
  EXPECT_EQ(errorMessage(kPng), "");
  EXPECT_EQ(errorMessage({}), "images[0] (a.png): is not a PNG, JPEG or WebP file");
  EXPECT_NE(errorMessage({'R', 'I', 'F', 'F', 0, 0, 0, 0, 'W', 'E', 'B', 'P'}).find("not a WebP"),
            std::string::npos);
  EXPECT_NE(errorMessage({kPng.begin(), kPng.begin() + 50}).find("damaged image"),
            std::string::npos);
}

}  // namespace
}  // namespace chromeball::gltf_material_test
