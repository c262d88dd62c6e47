// SPDX-License-Identifier: Apache-2.0
#include "bake/gltf_document.h"

#include <fmt/format.h>

#include "image/io/write_image.h"
#include "image/tonemap.h"

namespace chromeball {
namespace {

using Json = GltfDocument::Json;

constexpr int kNearest = 9728, kLinear = 9729, kLinearMipmap = 9987;           // filters
constexpr int kClampToEdge = 33071, kMirroredRepeat = 33648, kRepeat = 10497;  // wrapping

int wrapOf(Wrap wrap) {
  return wrap == Wrap::Repeat        ? kRepeat
         : wrap == Wrap::ClampToEdge ? kClampToEdge
                                     : kMirroredRepeat;
}

Json toJson(const Rgb& c) { return {c.x, c.y, c.z}; }

uint8_t byteOf(float unit) { return uint8_t(std::lround(255 * std::clamp(unit, 0.0f, 1.0f))); }

// KHR_texture_transform: uv' = offset + R(rotation) S(scale) uv, with
//   R S = (cos r sx, sin r sy; -sin r sx, cos r sy).
Json transformOf(const TextureSlot& slot) {
  // From the column of the larger scale: one of 0 has no direction.
  const vec2 first(slot.uvRow0.x, slot.uvRow1.x), second(slot.uvRow0.y, slot.uvRow1.y);
  const float rotation = glm::dot(first, first) >= glm::dot(second, second)
                             ? std::atan2(-first.y, first.x)
                             : std::atan2(second.x, second.y);
  const float cosine = std::cos(rotation), sine = std::sin(rotation);
  const float scaleX = cosine * slot.uvRow0.x - sine * slot.uvRow1.x;
  const float scaleY = sine * slot.uvRow0.y + cosine * slot.uvRow1.y;
  return {{"offset", {slot.uvOffset.x, slot.uvOffset.y}},
          {"rotation", rotation},
          {"scale", {scaleX, scaleY}}};
}

bool isMoved(const TextureSlot& slot) {
  return slot.uvRow0 != vec2(1, 0) || slot.uvRow1 != vec2(0, 1) || slot.uvOffset != vec2(0);
}

}  // namespace

std::vector<uint8_t> pngOf(const Image& linear, bool srgb) {
  bool hasAlpha = false;
  for (size_t i = 3; linear.channels == 4 && i < linear.texels.size(); i += 4)
    hasAlpha |= linear.texels[i] < 1;
  const int channels = linear.channels == 1 ? 1 : hasAlpha ? 4 : 3;
  std::vector<uint8_t> bytes;
  bytes.reserve(linear.texels.size());
  for (size_t i = 0; i < linear.texels.size(); i += size_t(linear.channels))
    for (int c = 0; c < channels; ++c) {
      const float texel = linear.texels[i + size_t(c)];
      bytes.push_back(byteOf(srgb && c < 3 ? linearToSrgb(std::clamp(texel, 0.0f, 1.0f)) : texel));
    }
  return encodePng(linear.width, linear.height, channels, bytes);
}

int GltfMaterials::imageOf(const Texture& texture) {
  const auto [found, isNew] = images_.try_emplace({texture.grid, texture.srgb}, 0);
  if (!isNew) return found->second;
  const TexelGrid& grid = *texture.grid;
  Image image(grid.width, grid.height, 4);
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      const vec4 texel = linearTexel(grid, texture.srgb, x, y);
      for (int c = 0; c < 4; ++c) image.at(x, y)[c] = texel[c];
    }
  const std::string name = fmt::format("texture {}", images_.size());
  return found->second = document_.addPng(pngOf(image, texture.srgb), name);
}

int GltfMaterials::textureOf(int index) {
  const auto [found, isNew] = textures_.try_emplace(index, 0);
  if (!isNew) return found->second;
  const Texture& texture = scene_.textures[size_t(index)];
  const bool nearest = texture.filter == Filter::Nearest;
  const int sampler = document_.add("samplers", {{"magFilter", nearest ? kNearest : kLinear},
                                                 {"minFilter", nearest ? kNearest : kLinearMipmap},
                                                 {"wrapS", wrapOf(texture.wrapS)},
                                                 {"wrapT", wrapOf(texture.wrapT)}});
  return found->second =
             document_.add("textures", {{"sampler", sampler}, {"source", imageOf(texture)}});
}

int GltfMaterials::addPage(std::span<const uint8_t> png, const std::string& name) {
  const int image = document_.addPng(png, name);
  const int sampler = document_.add("samplers", {{"magFilter", kLinear},
                                                 {"minFilter", kLinear},
                                                 {"wrapS", kClampToEdge},
                                                 {"wrapT", kClampToEdge}});
  return document_.add("textures", {{"sampler", sampler}, {"source", image}});
}

Json GltfMaterials::textureInfo(const TextureSlot& slot) {
  Json info = {{"index", textureOf(slot.texture)}};
  const int set = slot.uvSet + (movesSets_ && slot.uvSet >= kLightmapSet);
  if (set > 0) info["texCoord"] = set;
  if (isMoved(slot)) {
    info["extensions"]["KHR_texture_transform"] = transformOf(slot);
    document_.use("KHR_texture_transform");
  }
  return info;
}

Json GltfMaterials::common(const Material& m, const Json& pbr) {
  Json json;
  if (!m.name.empty()) json["name"] = m.name;
  json["pbrMetallicRoughness"] = pbr;
  if (m.alphaMode != AlphaMode::Opaque)
    json["alphaMode"] = m.alphaMode == AlphaMode::Mask ? "MASK" : "BLEND";
  if (m.alphaMode == AlphaMode::Mask) json["alphaCutoff"] = m.alphaCutoff;
  if (m.doubleSided) json["doubleSided"] = true;
  return json;
}

Json GltfMaterials::shown(const Material& m, const Json& pbr) {
  Json json = common(m, pbr);
  json["extensions"]["KHR_materials_unlit"] = Json::object();
  document_.use("KHR_materials_unlit");
  return json;
}

Json GltfMaterials::lit(const Material& m) {
  const vec4& c = m.baseColor;
  Json pbr = {{"baseColorFactor", {c.x, c.y, c.z, c.w}},
              {"metallicFactor", m.metallic},
              {"roughnessFactor", m.roughness}};
  if (m.baseColorTexture) pbr["baseColorTexture"] = textureInfo(m.baseColorTexture);
  if (m.unlit) return shown(m, pbr);
  if (m.metallicRoughnessTexture)
    pbr["metallicRoughnessTexture"] = textureInfo(m.metallicRoughnessTexture);
  Json json = common(m, pbr);
  if (m.normalTexture) {
    json["normalTexture"] = textureInfo(m.normalTexture);
    json["normalTexture"]["scale"] = m.normalScale;
  }
  const auto extend = [&](const char* name, const char* key, const Json& member) {
    json["extensions"][name][key] = member;
    document_.use(name);
  };
  if (m.emits()) {
    const float strength = std::max(maxComponent(m.emission), 1.0f);
    json["emissiveFactor"] = toJson(m.emission / strength);
    if (strength > 1) extend("KHR_materials_emissive_strength", "emissiveStrength", strength);
    if (m.emissiveTexture) json["emissiveTexture"] = textureInfo(m.emissiveTexture);
  }
  if (m.specularGlossiness) {
    const char* name = "KHR_materials_pbrSpecularGlossiness";
    extend(name, "diffuseFactor", pbr["baseColorFactor"]);
    if (m.baseColorTexture) extend(name, "diffuseTexture", pbr["baseColorTexture"]);
    extend(name, "specularFactor", toJson(m.specularColor));
    extend(name, "glossinessFactor", 1 - m.roughness);
    if (m.specularColorTexture)
      extend(name, "specularGlossinessTexture", textureInfo(m.specularColorTexture));
    return json;
  }
  if (m.ior != 1.5f) extend("KHR_materials_ior", "ior", m.ior);
  if (m.specular != 1) extend("KHR_materials_specular", "specularFactor", m.specular);
  if (m.specularColor != Rgb(1))
    extend("KHR_materials_specular", "specularColorFactor", toJson(m.specularColor));
  if (m.specularTexture)
    extend("KHR_materials_specular", "specularTexture", textureInfo(m.specularTexture));
  if (m.specularColorTexture)
    extend("KHR_materials_specular", "specularColorTexture", textureInfo(m.specularColorTexture));
  return json;
}

// Viewers without the extension show a rough surface of this colour.
Json GltfMaterials::unlit(const Material& m) {
  const vec4& c = m.baseColor;
  Json pbr = {
      {"baseColorFactor", {c.x, c.y, c.z, c.w}}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
  if (m.baseColorTexture) pbr["baseColorTexture"] = textureInfo(m.baseColorTexture);
  return shown(m, pbr);
}

Json GltfMaterials::lightmapped(const Material& m, int texture) {
  return shown(m, {{"baseColorTexture", {{"index", texture}, {"texCoord", kLightmapSet}}},
                   {"metallicFactor", 0},
                   {"roughnessFactor", 1}});
}

Json GltfMaterials::coloured(const Material& m) {
  return shown(m, {{"metallicFactor", 0}, {"roughnessFactor", 1}});
}

}  // namespace chromeball
