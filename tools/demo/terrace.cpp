// SPDX-License-Identifier: Apache-2.0
#include "gallery.h"

#include "flat.h"
#include "glb_objects.h"
#include "probe/synth.h"
#include "texels.h"

namespace chromeball::demo {
namespace {

constexpr float kTextureSize = 3;  // metres of wall or floor that a texture covers

Surface floorSlab() {
  Surface s;
  addQuad(s, {-20, 0, 12}, {40, 0, 0}, {0, 0, -40}, kTextureSize);
  return s;
}

Surface parapet() {
  Surface s;
  addBox(s, {-7, 0, -3.6f}, {7, 0.9f, -3.3f}, kTextureSize);
  addBox(s, {-7.1f, 0.9f, -3.68f}, {7.1f, 1, -3.22f}, kTextureSize);
  return s;
}

Surface pillar(float x) {
  Surface s;
  const auto block = [&](float half, float bottom, float top) {
    addBox(s, {x - half, bottom, -3.0f - half}, {x + half, top, -3.0f + half}, kTextureSize);
  };
  block(0.36f, 0, 0.22f);
  block(0.25f, 0.22f, 2.6f);
  block(0.33f, 2.6f, 2.85f);
  return s;
}

// Slabs in rows with different offsets.
Image slabs(int size) {
  Image image(size, size, 3);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const float pz = 4.0f * float(y) / float(size), row = std::floor(pz);
      const float px = 3.0f * float(x) / float(size) + (int(row) % 2 ? 0.5f : 0);
      const float slab = std::floor(px) - 3 * std::floor(px / 3);
      const float edge =
          std::min({px - std::floor(px), 1 - (px - std::floor(px)), pz - row, 1 - (pz - row)});
      const float tone = 0.8f + 0.4f * toUnit(uint32_t(hash(uint64_t(slab), uint64_t(row))));
      const float stain = fractalNoise({1.9f * px, 1.9f * pz, 4}, 5);
      const float grain = fractalNoise({24 * px, 24 * pz, 8}, 3);
      const Rgb stone = glm::mix(Rgb(0.36f, 0.3f, 0.23f), Rgb(0.5f, 0.45f, 0.38f), stain);
      image.setRgb(x, y,
                   stone * tone * (0.8f + 0.4f * grain) *
                       (0.35f + 0.65f * glm::smoothstep(0.006f, 0.022f, edge)));
    }
  return image;
}

Image plaster(int size) {
  Image image(size, size, 3);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const vec3 p(6.0f * float(x) / float(size), 6.0f * float(y) / float(size), 2);
      const float worn = glm::smoothstep(0.42f, 0.7f, fractalNoise(p, 5));
      const float grain = 0.85f + 0.3f * fractalNoise(11.0f * p, 3);
      image.setRgb(x, y, grain * glm::mix(Rgb(0.55f, 0.38f, 0.24f), Rgb(0.42f, 0.36f, 0.3f), worn));
    }
  return image;
}

std::vector<Object> realThings() {
  std::vector<Object> things = {
      {"floor", floorSlab(), {1, 1, 1}},
      {"wall", parapet(), {1, 1, 1}},
      {"pillar", pillar(-2.3f), {0.52f, 0.48f, 0.42f}},
      {"pillar", pillar(2.3f), {0.52f, 0.48f, 0.42f}},
      {"vase", tessellate(72, 90, vase({-1.15, 0, -2.35})), {0.42f, 0.17f, 0.09f}},
  };
  for (Object& thing : things) thing.lambertian = true;
  return things;
}

std::vector<Object> syntheticThings() {
  std::vector<Object> things;
  const auto add = [&](const char* name, Surface surface, Rgb color, float metallic,
                       float roughness) {
    things.push_back({name, std::move(surface), color, metallic, roughness});
  };
  add("chrome ball", tessellate(112, 56, ball({0.35, 0.6, -0.75}, 0.6)), Rgb(0.9f), 1, 0.02f);
  add("golden knot", tessellate(220, 26, knot({-1.15, 0.62, -0.35}, 0.42, 0.13, 0.5)),
      {1, 0.71f, 0.29f}, 1, 0.22f);
  add("red cube", tessellate(96, 48, softCube({1.55, 0.32, -0.1}, 0.32, 0.5)), {0.6f, 0.03f, 0.03f},
      0, 0.3f);
  add("white ball", tessellate(88, 44, ball({2.05, 0.4, -1.9}, 0.4)), Rgb(0.75f), 0, 1);
  add("blue ball", tessellate(88, 44, ball({-0.25, 0.2, 0.75}, 0.2)), {0.03f, 0.12f, 0.5f}, 0,
      0.08f);
  return things;
}

}  // namespace

void writeTerrace(const std::string& path, Terrace what) {
  GltfDocument glb;
  std::vector<Object> things = realThings();
  if (what == Terrace::Model) {
    for (Object& thing : things) thing.color = Rgb(0.3f);
  } else {
    things[0].texture = addTexture(glb, slabs(1024));
    things[1].texture = addTexture(glb, plaster(512));
  }
  for (const Object& thing : things) addObject(glb, thing);
  if (what != Terrace::Photograph)
    for (const Object& thing : syntheticThings()) addObject(glb, thing);
  writeScene(
      glb, "View",
      Camera::lookAt({0.5f, 1.6f, 5.6f}, {0.25f, 0.85f, -0.6f}, {0, 1, 0}, glm::radians(32.0f)),
      path);
}

Image terraceProbe(int width) {
  Image sky = clearSkyProbe({width, width / 2}, {42, 132, 2, 0.3});
  roundTexels(sky);
  return sky;
}

}  // namespace chromeball::demo
