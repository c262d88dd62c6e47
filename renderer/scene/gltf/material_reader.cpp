// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/material_reader.h"

#include <limits>

#include <fmt/format.h>

#include "scene/gltf/gltf_json.h"

namespace chromeball {
namespace {

using tinygltf::Value;

constexpr float kLargest = std::numeric_limits<float>::max();

Wrap readWrap(const GltfFile& file, int code, const std::string& where) {
  if (code == TINYGLTF_TEXTURE_WRAP_REPEAT) return Wrap::Repeat;
  if (code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::ClampToEdge;
  if (code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::MirroredRepeat;
  file.fail("{}: {} is not {} (repeat), {} (clamp to edge) or {} (mirrored repeat)", where, code,
            TINYGLTF_TEXTURE_WRAP_REPEAT, TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE,
            TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT);
}

Filter readFilter(const GltfFile& file, int code, const std::string& where) {
  if (code == TINYGLTF_TEXTURE_FILTER_NEAREST) return Filter::Nearest;
  if (code != TINYGLTF_TEXTURE_FILTER_LINEAR && code != -1)
    file.fail("{}: {} is not {} (nearest) or {} (linear)", where, code,
              TINYGLTF_TEXTURE_FILTER_NEAREST, TINYGLTF_TEXTURE_FILTER_LINEAR);
  return Filter::Linear;
}

}  // namespace

int MaterialReader::use(int index, const std::string& where) {
  if (const auto found = materialOf_.find(index); found != materialOf_.end()) return found->second;
  Material material;
  if (index != -1)
    material = convert(file_.at(file_.model.materials, index, "materials", where),
                       fmt::format("materials[{}]", index));
  else
    material.name = "default";
  materials_.push_back(std::move(material));
  return materialOf_[index] = int(materials_.size()) - 1;
}

Material MaterialReader::convert(const tinygltf::Material& source, const std::string& where) {
  Material m;
  m.name = source.name;
  const TexelUse use{.srgb = true, .weightedByAlpha = source.alphaMode != "OPAQUE"};
  constexpr const char* kGlossiness = "KHR_materials_pbrSpecularGlossiness";
  const auto named = [&](const char* name) { return find(source.extensions, name, where); };
  const auto glossiness = find(source.extensions, kGlossiness, where + "." + kGlossiness);
  if (glossiness)
    readSpecularGlossiness(*glossiness, use, m);
  else
    readBaseColor(source, use, where, m);
  m.doubleSided = source.doubleSided;
  m.alphaCutoff = number(file_, source.alphaCutoff, 0, 1e6, where + ".alphaCutoff");
  if (source.alphaMode == "MASK")
    m.alphaMode = AlphaMode::Mask;
  else if (source.alphaMode == "BLEND")
    m.alphaMode = AlphaMode::Blend;
  else if (source.alphaMode != "OPAQUE")
    file_.fail("{}.alphaMode: \"{}\" is not OPAQUE, MASK or BLEND", where, source.alphaMode);
  if (named("KHR_materials_unlit")) {
    m.unlit = true;
    return m;
  }

  if (!glossiness) {
    const auto& pbr = source.pbrMetallicRoughness;
    m.metallic = number(file_, pbr.metallicFactor, 0, 1, where + ".metallicFactor");
    m.roughness = number(file_, pbr.roughnessFactor, 0, 1, where + ".roughnessFactor");
    m.metallicRoughnessTexture =
        slot(pbr.metallicRoughnessTexture, {}, where + ".metallicRoughnessTexture");
  }
  m.normalScale = number(file_, source.normalTexture.scale, -1e6, 1e6, where + ".normalTexture");
  m.normalTexture = slot(source.normalTexture, {}, where + ".normalTexture");

  float strength = 1;
  if (const auto e = named("KHR_materials_emissive_strength"))
    strength = e->number("emissiveStrength", 1, 0, 1e30);
  for (int i = 0; i < 3; ++i)
    m.emission[i] =
        strength * number(file_, source.emissiveFactor[size_t(i)], 0, 1, where + ".emissiveFactor");
  if (!isBlack(m.emission))
    m.emissiveTexture = slot(source.emissiveTexture, {.srgb = true}, where + ".emissiveTexture");

  if (const auto e = named("KHR_materials_ior"); e && !glossiness) {
    m.ior = e->number("ior", 1.5, 0, 1e6);
    if (m.ior != 0 && m.ior < 1) {
      file_.warnOnce(
          fmt::format("{}: {} is clamped to the range 1 to 1e+06, or 0", where + ".ior", m.ior));
      m.ior = 1;
    }
  }
  if (const auto e = named("KHR_materials_specular"); e && !glossiness) {
    m.specular = e->number("specularFactor", 1);
    m.specularColor = e->color("specularColorFactor", Rgb(1), kLargest);
    m.specularTexture = e->texture("specularTexture");
    m.specularColorTexture = e->texture("specularColorTexture", {.srgb = true});
  }
  m.extended = readExtensions(source.extensions, where);
  if (m.extended && m.ior == 0) m.extended->transmission = 0;  // infinite index: reflects all light
  return m;
}

void MaterialReader::readBaseColor(const tinygltf::Material& source, TexelUse use,
                                   const std::string& where, Material& m) {
  const auto& pbr = source.pbrMetallicRoughness;
  for (int i = 0; i < 4; ++i)
    m.baseColor[i] =
        number(file_, pbr.baseColorFactor[size_t(i)], 0, 1, where + ".baseColorFactor");
  m.baseColorTexture = slot(pbr.baseColorTexture, use, where + ".baseColorTexture");
}

// The specular colour is F0 itself, as with an infinite index of refraction; its texture's alpha is
// the glossiness.
void MaterialReader::readSpecularGlossiness(const Extension& e, TexelUse diffuse, Material& m) {
  m.specularGlossiness = true;
  m.ior = 0;
  m.metallic = 0;
  m.baseColor = vectorMember<4>(e.reader.file_, e.object, "diffuseFactor", vec4(1), 0, 1, e.where);
  m.baseColorTexture = e.texture("diffuseTexture", diffuse);
  m.specularColor = e.color("specularFactor", Rgb(1));
  m.roughness = 1 - e.number("glossinessFactor", 1);
  m.specularColorTexture = e.texture("specularGlossinessTexture", {.srgb = true});
}

TextureSlot MaterialReader::slot(int index, int uvSet, const tinygltf::ExtensionMap& extensions,
                                 TexelUse use, const std::string& where) {
  TextureSlot s;
  if (index == -1) return s;
  s.texture = texture(index, use, where);
  s.uvSet = uvSet;
  if (const Value* e = findExtension(extensions, "KHR_texture_transform")) {
    const std::string at = where + ".KHR_texture_transform";
    const float angle = member(file_, *e, "rotation", 0, -1e6, 1e6, at);
    const vec2 scale = vectorMember<2>(file_, *e, "scale", vec2(1), -kLargest, kLargest, at);
    const float c = std::cos(angle), sn = std::sin(angle);
    // The rotation is counter-clockwise as seen, with v pointing down.
    s.uvRow0 = vec2(c, sn) * scale;
    s.uvRow1 = vec2(-sn, c) * scale;
    s.uvOffset = vectorMember<2>(file_, *e, "offset", vec2(0), -kLargest, kLargest, at);
    s.uvSet = intMember(*e, "texCoord", uvSet);
  }
  if (s.uvSet < 0 || s.uvSet > kMaxUvSet)
    file_.fail("{}: texCoord {} is not in the range 0 to {}", where, s.uvSet, kMaxUvSet);
  return s;
}

int MaterialReader::texture(int index, TexelUse use, const std::string& where) {
  const tinygltf::Texture& source = file_.at(file_.model.textures, index, "textures", where);
  int image = source.source;
  if (const Value* e = findExtension(source.extensions, "EXT_texture_webp"))
    image = intMember(*e, "source");
  if (image == -1 && findExtension(source.extensions, "KHR_texture_basisu"))
    file_.fail(
        "textures[{}]: has only a KTX2 image (KHR_texture_basisu), which is not supported; "
        "convert it to PNG, JPEG or WebP (`ktx extract` of KTX-Software can)",
        index);
  if (image == -1) {
    file_.warnOnce("ignored: textures without an image");
    return -1;
  }
  Texture t;
  t.srgb = use.srgb;
  t.weightedByAlpha = use.weightedByAlpha;
  if (source.sampler != -1) {
    const tinygltf::Sampler& sampler =
        file_.at(file_.model.samplers, source.sampler, "samplers", where);
    const std::string at = fmt::format("samplers[{}]", source.sampler);
    t.wrapS = readWrap(file_, sampler.wrapS, at + ".wrapS");
    t.wrapT = readWrap(file_, sampler.wrapT, at + ".wrapT");
    t.filter = readFilter(file_, sampler.magFilter, at + ".magFilter");
  }
  file_.at(file_.images, image, "images", where);
  const TextureKey key{image, t.wrapS, t.wrapT, t.filter, t.srgb, t.weightedByAlpha};
  if (const auto found = textureOf_.find(key); found != textureOf_.end()) return found->second;
  t.grid = grid(image);
  textures_.push_back(t);
  return textureOf_[key] = int(textures_.size()) - 1;
}

TexelGrid* MaterialReader::grid(int image) {
  const auto [found, isNew] = gridOf_.try_emplace(image, int(grids_.size()));
  if (isNew) {
    std::shared_ptr<TexelGrid> cached;
    if (cache_)
      if (const auto at = cache_->grids.find({file_.files().front(), image});
          at != cache_->grids.end())
        cached = at->second;
    grids_.push_back(cached ? std::move(cached) : std::make_shared<TexelGrid>());
    imageOf_.push_back(image);
  }
  return grids_[size_t(found->second)].get();
}

// Textures of one image that differ in their samplers only share the mip levels.
void MaterialReader::moveInto(Scene& scene) {
  TexelCache own;
  TexelCache& cache = cache_ ? *cache_ : own;
  for (const Texture& t : textures_) cache.chains[{t.grid, t.srgb, t.weightedByAlpha}];
  std::vector<ImageToDecode> images;
  for (size_t i = 0; i < grids_.size(); ++i) {
    ImageToDecode& image = images.emplace_back();
    image.image = imageOf_[i];
    image.grid = grids_[i].get();
    for (bool srgb : {false, true})
      for (bool weighted : {false, true})
        if (const auto wanted = cache.chains.find({image.grid, srgb, weighted});
            wanted != cache.chains.end() && !wanted->second)
          image.chains.push_back({srgb, weighted, &wanted->second});
  }
  decodeImages(file_, images, cache);
  for (Texture& t : textures_) t.mipLevels = cache.chains[{t.grid, t.srgb, t.weightedByAlpha}];
  for (size_t i = 0; i < grids_.size(); ++i)
    cache.grids.try_emplace({file_.files().front(), imageOf_[i]}, grids_[i]);
  scene.texelFile = cache.file;
  scene.materials = std::move(materials_);
  scene.textures = std::move(textures_);
  scene.grids = std::move(grids_);
}

std::vector<std::string> variantNames(const GltfFile& file) {
  std::vector<std::string> names;
  const Value* extension = findExtension(file.model.extensions, kVariantsExtension);
  if (!extension) return names;
  const Value& list = memberOf(*extension, "variants");
  for (size_t i = 0; i < list.ArrayLen(); ++i)
    names.push_back(textMember(elementOf(list, i), "name"));
  return names;
}

}  // namespace chromeball
