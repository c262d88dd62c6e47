#include "scene/gltf_variants.h"

#include <algorithm>

#include "math/suggest.h"
#include "scene/gltf_value.h"

namespace chromeball {
namespace {

using tinygltf::Value;

constexpr const char* kVariants = "KHR_materials_variants";

std::vector<std::string> variantNames(const GltfFile& file) {
  std::vector<std::string> names;
  const Value* extension = findExtension(file.model.extensions, kVariants);
  if (!extension) return names;
  const Value& list = extension->Get("variants");
  for (size_t i = 0; i < list.ArrayLen(); ++i) {
    const Value& name = list.Get(int(i)).Get("name");
    names.push_back(name.IsString() ? name.Get<std::string>() : "");
  }
  return names;
}

// The material of the mapping that lists the variant; -2 where none does.
int mappedMaterial(const Value& extension, int variant) {
  const Value& mappings = extension.Get("mappings");
  for (size_t i = 0; i < mappings.ArrayLen(); ++i) {
    const Value& mapping = mappings.Get(int(i));
    const Value& variants = mapping.Get("variants");
    for (size_t k = 0; k < variants.ArrayLen(); ++k)
      if (variants.Get(int(k)).IsInt() && variants.Get(int(k)).GetNumberAsInt() == variant &&
          mapping.Get("material").IsInt())
        return std::max(mapping.Get("material").GetNumberAsInt(), -1);
  }
  return -2;
}

}  // namespace

void applyVariant(GltfFile& file, const VariantChoice& choice) {
  const std::vector<std::string> names = variantNames(file);
  const auto found = std::find(names.begin(), names.end(), choice.name);
  if (names.empty()) file.fail("has no variants ({} asks for one)", choice.place);
  if (found == names.end())
    file.fail("has no variant `{}` ({}); {}", choice.name, choice.place,
              didYouMean(choice.name, {names.begin(), names.end()}));
  const int variant = int(found - names.begin());
  for (tinygltf::Mesh& mesh : file.model.meshes)
    for (tinygltf::Primitive& primitive : mesh.primitives)
      if (const Value* extension = findExtension(primitive.extensions, kVariants))
        if (const int material = mappedMaterial(*extension, variant); material != -2)
          primitive.material = material;
}

}  // namespace chromeball
