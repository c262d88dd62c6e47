// SPDX-License-Identifier: Apache-2.0
// Writes a baked model as glTF.
#pragma once

#include <filesystem>
#include <optional>

#include "bake/bake.h"
#include "bake/gltf_document.h"
#include "bake/lightmap.h"
#include "bake/placed_mesh.h"

namespace chromeball {

// How a viewer is to show the light.
enum class BakedLook {
  Unlit,     // the light is all that surfaces show (KHR_materials_unlit)
  Occluded,  // the materials of the model, with ambient occlusion (occlusionTexture)
  Lit        // the materials of the model; the light is for an engine
};

struct BakedFile {
  BakedLook look;
  BakedLight what;
  float scale = 1;       // colours and texels of the file times this are the light
  glm::dvec3 origin{0};  // of the scene's coordinates, metres
  std::optional<Camera> camera;
  float aspect = 1;           // of the camera, if it states none
  GltfDocument::Json extras;  // of the file
  // Accessors that no vertex refers to; extras.chromeball.tables has their indices by name.
  std::vector<NamedArray> tables = {};
};

// A lightmap's page: shown / scale as sRGB PNG, or the occlusion as grey.
std::vector<uint8_t> pageOf(const Lightmap& map, const BakedFile& file);

// One node for each instance that has triangles, in the scene's coordinates. `page`: the PNG that
// materials refer to; empty: they refer to none. Writes atomically; throws RunError.
void writeBaked(const std::filesystem::path& path, const Scene& scene,
                const std::vector<BakedGeometry>& geometry, const std::vector<uint8_t>& page,
                const BakedFile& file);

}  // namespace chromeball
