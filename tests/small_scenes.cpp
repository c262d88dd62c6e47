// SPDX-License-Identifier: Apache-2.0
#include "small_scenes.h"

#include "probe/synth.h"

namespace chromeball {

std::vector<NamedScene> threeScenes() {
  std::vector<NamedScene> scenes(3);
  {
    scenes[0].name = "matte spheres on a plane under a gradient with a lamp";
    Scene& s = scenes[0].scene;
    addQuad(s, addMaterial(s, lambert({0.7f, 0.6f, 0.5f})), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    addSphere(s, addMaterial(s, lambert({0.8f, 0.2f, 0.2f})), {-0.7f, 0.6f, 0}, 0.6f, 16);
    addSphere(s, addMaterial(s, lambert({0.2f, 0.3f, 0.8f})), {0.8f, 0.5f, 0.3f}, 0.5f, 16, false);
    scenes[0].probe = gradientProbe({32, 16}, Rgb(0.3f, 0.4f, 0.5f), {0.2, 0.7, 0.3});
    for (int x = 8; x < 12; ++x) scenes[0].probe.setRgb(x, 3, Rgb(20, 15, 10));
  }
  {
    scenes[1].name = "metals and plastics in a studio";
    Scene& s = scenes[1].scene;
    addQuad(s, addMaterial(s, lambert(Rgb(0.5f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    Material gold;
    gold.baseColor = {1, 0.8f, 0.4f, 1};
    gold.roughness = 0.3f;
    addSphere(s, addMaterial(s, gold), {-0.7f, 0.6f, 0}, 0.6f, 24);
    Material plastic;
    plastic.baseColor = {0.1f, 0.5f, 0.2f, 1};
    plastic.metallic = 0;
    plastic.roughness = 0.5f;
    addSphere(s, addMaterial(s, plastic), {0.8f, 0.6f, 0.3f}, 0.6f, 24);
    scenes[1].probe = studioProbe({64, 32});
  }
  {
    scenes[2].name = "a lamp, a mirror and a veil";
    Scene& s = scenes[2].scene;
    addQuad(s, addMaterial(s, lambert(Rgb(0.6f))), {-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    Material mirror;
    mirror.roughness = 0;
    addSphere(s, addMaterial(s, mirror), {-0.7f, 0.6f, 0}, 0.6f, 24);
    Material lamp = lambert(Rgb(0.2f));
    lamp.emission = {4, 3, 2};
    addSphere(s, addMaterial(s, lamp), {0.9f, 1.4f, 0}, 0.5f, 12);
    Material veil = lambert({0.9f, 0.4f, 0.4f});
    veil.alphaMode = AlphaMode::Blend;
    veil.baseColor.w = 0.4f;
    addQuad(s, addMaterial(s, veil), {0.2f, 0, 1}, {1.2f, 0, 0}, {0, 1, 0});
    scenes[2].probe = overcastProbe({32, 16}, Rgb(0.5f), 0.2);
  }
  return scenes;
}

}  // namespace chromeball
