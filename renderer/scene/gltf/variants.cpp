// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/variants.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "scene/gltf/gltf_json.h"

namespace chromeball {
namespace {

using tinygltf::Value;

constexpr const char* kVariants = "KHR_materials_variants";

std::vector<std::string> variantNames(const GltfFile& file) {
  std::vector<std::string> names;
  const Value* extension = findExtension(file.model.extensions, kVariants);
  if (!extension) return names;
  const Value& list = memberOf(*extension, "variants");
  for (size_t i = 0; i < list.ArrayLen(); ++i) {
    const Value& name = memberOf(elementOf(list, i), "name");
    names.push_back(name.IsString() ? name.Get<std::string>() : "");
  }
  return names;
}

// The valid mappings of a primitive.
struct Mapping {
  int material;
  std::vector<int> variants;
};
std::vector<Mapping> mappingsOf(const Value& extension) {
  std::vector<Mapping> result;
  const Value& mappings = memberOf(extension, "mappings");
  for (size_t i = 0; i < mappings.ArrayLen(); ++i) {
    const Value& mapping = elementOf(mappings, i);
    if (!memberOf(mapping, "material").IsInt()) continue;
    Mapping& m = result.emplace_back(Mapping{memberOf(mapping, "material").GetNumberAsInt(), {}});
    const Value& variants = memberOf(mapping, "variants");
    for (size_t k = 0; k < variants.ArrayLen(); ++k)
      if (elementOf(variants, k).IsInt())
        m.variants.push_back(elementOf(variants, k).GetNumberAsInt());
  }
  return result;
}

// Warns if the mapping refers to variants or materials that do not exist.
void warnOfDangling(GltfFile& file, const Mapping& mapping, size_t variantCount) {
  for (const int variant : mapping.variants)
    if (variant < 0 || size_t(variant) >= variantCount)
      file.warnOnce(
          fmt::format("a mapping refers to variants[{}], which does not exist ({} in the file)",
                      variant, variantCount));
  if (mapping.material < 0 || size_t(mapping.material) >= file.model.materials.size())
    file.warnOnce(
        fmt::format("a mapping refers to materials[{}], which does not exist ({} in the file)",
                    mapping.material, file.model.materials.size()));
}

}  // namespace

void applyVariant(GltfFile& file, const VariantChoice& choice) {
  const std::vector<std::string> names = variantNames(file);
  const auto found = std::find(names.begin(), names.end(), choice.name);
  if (names.empty()) file.fail("has no variants ({})", choice.location);
  if (found == names.end())
    file.fail("has no variant `{}` ({}); {}", choice.name, choice.location,
              didYouMean(choice.name, {names.begin(), names.end()}));
  const int variant = int(found - names.begin());
  bool isUsed = false;
  for (tinygltf::Mesh& mesh : file.model.meshes)
    for (tinygltf::Primitive& primitive : mesh.primitives) {
      const Value* extension = findExtension(primitive.extensions, kVariants);
      if (!extension) continue;
      for (const Mapping& mapping : mappingsOf(*extension)) {
        warnOfDangling(file, mapping, names.size());
        const auto& variants = mapping.variants;
        const bool exists =
            mapping.material >= 0 && size_t(mapping.material) < file.model.materials.size();
        if (!exists || std::find(variants.begin(), variants.end(), variant) == variants.end())
          continue;
        primitive.material = mapping.material;
        isUsed = true;
      }
    }
  if (!isUsed)
    file.warnOnce(
        fmt::format("variant `{}` has no effect: no primitive has a material for it", choice.name));
}

}  // namespace chromeball
