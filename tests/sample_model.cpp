// SPDX-License-Identifier: Apache-2.0
#include "sample_model.h"

#include "scene/gltf/load_gltf.h"
#include "shared_data.h"

namespace chromeball {

std::optional<Scene> sampleModel(const std::string& name) {
  const auto path = sharedData("gltf/" + name + "/glTF/" + name + ".gltf");
  if (!path) return std::nullopt;
  return loadGltf(path->string(), {}, nullptr);
}

Image squareView(const Scene& scene, const vec3& centre, float halfHeight, int pixels,
                 const Probe& probe, RenderSettings settings) {
  Camera camera;
  camera.orthographic = true;
  camera.halfHeight = halfHeight;
  camera.position = {centre.x, centre.y, centre.z};
  settings.width = settings.height = pixels;
  return renderScene(scene, camera, probe, "importance", settings).film.mean();
}

Material& materialNamed(Scene& scene, const std::string& name) {
  for (Material& m : scene.materials)
    if (m.name == name) return m;
  throw std::runtime_error("no material " + name);
}

void makeLamp(Material& material) {
  material.baseColor = vec4(0, 0, 0, 1);
  material.specular = material.metallic = 0;
  material.emission = Rgb(1);
  material.doubleSided = true;
}

}  // namespace chromeball
