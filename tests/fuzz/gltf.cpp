// SPDX-License-Identifier: Apache-2.0
#include "scene/bounds.h"
#include "scene/gltf/load_gltf.h"

#include "fuzz.h"
#include "scene/surface.h"

// Reads the model, then checks that the vertices of its triangles exist and that its surfaces and
// materials can be evaluated.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  using namespace chromeball;
  const std::string path = fuzzFile(bytes, size, "model.glb");
  return readOrReject([&] {
    const Scene scene = loadGltf(path, {}, nullptr);
    bounds(scene);
    for (const Instance& instance : scene.instances) {
      const uint32_t triangles = uint32_t(scene.meshes[size_t(instance.mesh)].triangles.size());
      for (uint32_t t = 0; t < std::min(triangles, 16u); ++t) {
        const Surface surface = surfaceAt(scene, instance, t, {0.3f, 0.3f}, {0, 1, 0});
        materialAt(scene, surface);
        surfaceAlpha(scene, instance, t, {0.3f, 0.3f});
      }
    }
  });
}
