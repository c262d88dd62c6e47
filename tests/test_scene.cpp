// SPDX-License-Identifier: Apache-2.0
#include "test_scene.h"

#include "lighting/strategy.h"
#include "scene/builder/scene_builder.h"

namespace chromeball {

Material lambert(Rgb albedo) {
  Material m;
  m.baseColor = vec4(albedo, 1);
  m.metallic = 0;
  m.specular = 0;
  m.doubleSided = true;
  return m;
}

int addMaterial(Scene& scene, const Material& material) {
  return SceneBuilder(scene).addMaterial(material);
}

void addMesh(Scene& scene, int material, Mesh mesh) {
  SceneBuilder builder(scene);
  if (scene.nodeNames.empty()) builder.addNode("node");
  builder.addInstance(builder.addMesh(std::move(mesh), material), material, 0);
}

void addQuad(Scene& scene, int material, vec3 corner, vec3 a, vec3 b) {
  Mesh mesh;
  mesh.positions = {corner, corner + a, corner + a + b, corner + b};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  addMesh(scene, material, std::move(mesh));
}

void addSphere(Scene& scene, int material, vec3 centre, float radius, int n, bool smooth) {
  Mesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= 2 * n; ++j) {
      const float theta = kPi * float(i) / float(n);
      const float phi = kPi * float(j % (2 * n)) / float(n);  // no crack along the seam
      vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
      if (i == 0 || i == n) d = {0, i == 0 ? 1.0f : -1.0f, 0};
      mesh.positions.push_back(centre + radius * d);
      if (smooth) mesh.normals.push_back(radius < 0 ? -d : d);
    }
  const auto index = [&](int i, int j) { return uint32_t(i * (2 * n + 1) + j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      if (i > 0) mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i, j + 1)});
      if (i < n - 1)
        mesh.triangles.push_back({index(i, j + 1), index(i + 1, j), index(i + 1, j + 1)});
    }
  addMesh(scene, material, std::move(mesh));
}

Camera topCamera(float height, float fovDegrees) {
  return Camera::lookAt({0, height, 0}, {0, 0, 0}, {0, 0, -1}, fovDegrees * kPi / 180);
}

RenderResult renderScene(const Scene& scene, const Camera& camera, const Probe& probe,
                         const std::string& strategy, const RenderSettings& settings) {
  const World world(scene, {}, allTables());
  const auto lighting = makeStrategy(strategy, probe, settings.mis, "test");
  const std::atomic<bool> stop = false;
  return render(
      world, camera, *lighting, settings, [](double) {}, stop);
}

RenderSettings smallRender(int width, int height, uint32_t samples, int maxDepth, uint64_t seed) {
  RenderSettings s;
  s.width = width;
  s.height = height;
  s.samples = samples;
  s.maxDepth = maxDepth;
  s.seed = seed;
  s.adaptive = false;
  return s;
}

Rgb meanColor(const Image& image) {
  glm::dvec3 sum(0);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += glm::dvec3(image.rgb(x, y));
  return Rgb(sum / (double(image.width) * image.height));
}

}  // namespace chromeball
