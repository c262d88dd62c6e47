// SPDX-License-Identifier: Apache-2.0
// A scene and a probe from arrays, watched while it renders; then the probe is turned.
#include <chromeball/render.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

using namespace chromeball;

// A tetrahedron as a triangle soup: three vertices for each triangle.
std::shared_ptr<const Scene> tetrahedron() {
  const vec3 a(-1, 0, 1), b(1, 0, 1), c(0, 0, -1), top(0, 1.5f, 0);
  auto scene = std::make_shared<Scene>();
  SceneBuilder builder(*scene);
  Material clay;
  clay.name = "clay";
  clay.baseColor = {0.6f, 0.4f, 0.3f, 1};
  clay.metallic = 0;
  const int material = builder.addMaterial(clay);
  Mesh soup;
  soup.positions = {a, b, top, b, c, top, c, a, top, a, c, b};
  builder.addInstance(builder.addMesh(soup, material), material, builder.addNode("tetrahedron"));
  return scene;
}

// Lat-long: the left half of the environment is bright, the right half dim.
std::shared_ptr<const Image> sky() {
  auto map = std::make_shared<Image>(64, 32, 3);
  for (int y = 0; y < map->height; ++y)
    for (int x = 0; x < map->width; ++x)
      map->setRgb(x, y, x < 32 ? Rgb(2, 1.8f, 1.5f) : Rgb(0.1f, 0.1f, 0.2f));
  return map;
}

int main() try {
  RenderDescription description;
  description.scene = tetrahedron();
  description.probe.map = sky();
  description.lighting.strategy = "importance";  // without it, "auto"
  description.camera.placed =
      CameraEntry{.position = {0, 1, 4}, .target = {0, 0.6, 0}, .up = {0, 1, 0}};
  description.size = ImageSize{160, 120};
  description.settings.samples = 256;

  Session session(description);
  session.start();
  int snapshots = 0;
  for (; session.isRunning(); std::this_thread::sleep_for(std::chrono::milliseconds(20)))
    if (const auto soFar = session.snapshot()) {
      ++snapshots;
      std::printf("%.1f samples, noise %.2g%%\n", soFar->samples, 100 * soFar->noise);
    }
  writeImage("first.exr", session.wait().image);

  description.probe.rotation = Rotation(120);
  session.update(description);  // reads and builds nothing again but the tables of the probe
  session.start();
  writeImage("turned.exr", session.wait().image);
  const Session::Work work = session.work();
  std::printf("%d snapshots; again: scene %d, probe %d, lighting %d\n", snapshots, work.loadedScene,
              work.loadedProbe, work.preparedLighting);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
