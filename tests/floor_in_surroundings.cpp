// SPDX-License-Identifier: Apache-2.0
#include "floor_in_surroundings.h"

#include "base/hash.h"
#include "probe/synth.h"

namespace chromeball {

Surroundings box() {
  Surroundings s;
  s.shape = Surroundings::Shape::Box;
  s.min = {-2, 0, -3}, s.max = {3, 2.5f, 2};
  s.capture = {0.5f, 1, -0.5f};
  return s;
}

Image spotted() {
  Image probe = gradientProbe({32, 16}, Rgb(0.3f), {0.2, 0.6, 0.3});
  probe.setRgb(12, 4, Rgb(60, 40, 30));
  return probe;
}

vec3 sphereDirection(uint64_t i) {
  return squareToUniformSphere({toUnit(uint32_t(hash(2 * i))), toUnit(uint32_t(hash(2 * i + 1)))});
}

Moments floorRadiance(const LightSource& lighting, float x, float z, int repeats) {
  Scene scene;
  addQuad(scene, addMaterial(scene, lambert(Rgb(0.5f))), {-1.9f, 0.001f, 1.9f}, {3.8f, 0, 0},
          {0, 0, -3.8f});
  const World world(scene);
  const Camera camera = Camera::lookAt({x, 1.5f, z}, {x, 0, z}, {0, 0, -1}, 0.02f);
  const std::atomic<bool> stop = false;
  std::vector<double> means;
  for (int i = 0; i < repeats; ++i) {
    const RenderSettings settings = smallRender(4, 4, 512, 1, uint64_t(i));
    means.push_back(luminance(meanColor(render(
                                            world, camera, lighting, settings, [](double) {}, stop)
                                            .film.mean())));
  }
  return Moments::of(means);
}

}  // namespace chromeball
