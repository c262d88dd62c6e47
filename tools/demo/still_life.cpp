// SPDX-License-Identifier: Apache-2.0
#include "gallery.h"

#include "glb_objects.h"
#include "texels.h"

namespace chromeball::demo {
namespace {

// `fine`: with 0.9 million triangles.
std::vector<Object> stillLife(bool fine) {
  std::vector<Object> objects;
  const auto add = [&](const char* name, int columns, int rows, const Parametrisation& point,
                       Rgb color, float metallic, float roughness, float glow = 0) {
    objects.push_back({name, tessellate(fine ? 255 : columns, fine ? 254 : rows, point), color,
                       metallic, roughness, glow});
  };
  add("table", 128, 24, tableTop(), Rgb(1), 0, 0.38f);
  add("chrome ball", 112, 56, ball({-0.3, 0.62, -0.1}, 0.62), Rgb(0.95f), 1, 0.02f);
  add("copper vase", 72, 90, vase({-1.3, 0, -0.75}), {0.93f, 0.52f, 0.36f}, 1, 0.38f);
  add("golden knot", 220, 26, knot({0.95, 0.6, -0.6}, 0.42, 0.13, 0.35), {1, 0.71f, 0.29f}, 1,
      0.22f);
  add("white ball", 88, 44, ball({-1.05, 0.3, 0.62}, 0.3), {0.8f, 0.8f, 0.78f}, 0, 1);
  add("red cube", 96, 48, softCube({0.5, 0.27, 0.85}, 0.27, 0.5), {0.55f, 0.025f, 0.03f}, 0, 0.12f);
  add("lantern", 64, 32, ball({1.3, 0.17, 0.55}, 0.17), {0.8f, 0.6f, 0.4f}, 0, 0.6f, 1);
  return objects;
}

// A mirror and a golden ball on a diffuse ground, which their reflections light.
std::vector<Object> causticBalls() {
  const dvec3 x(1, 0, 0), z(0, 0, 1);
  return {
      {"ground", tessellate(2, 2, patch({-4, 0, 4}, 8.0 * x, -8.0 * z)), {0.5f, 0.5f, 0.5f}},
      {"mirror", tessellate(112, 56, ball({-0.7, 0.6, 0}, 0.6)), {0.95f, 0.95f, 0.95f}, 1, 0, 0},
      {"gold", tessellate(112, 56, ball({0.7, 0.6, 0.1}, 0.6)), {1, 0.71f, 0.29f}, 1, 0.1f, 0}};
}

// Walls of 9.5 by 6 by 4.5 m around the table and the camera, seen from inside. If there is a
// window, it is on the left, 3 by 2.3 m.
void addRoom(std::vector<Object>& objects, bool window) {
  const dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const auto add = [&](const char* name, dvec3 corner, dvec3 right, dvec3 up) {
    objects.push_back({name, tessellate(2, 2, patch(corner, right, up)), {0.7f, 0.68f, 0.64f}});
  };
  add("floor", {-3, -1, 6.5}, 6.0 * x, -9.5 * z);
  add("ceiling", {-3, 3.5, -3}, 6.0 * x, 9.5 * z);
  add("back", {-3, -1, -3}, 6.0 * x, 4.5 * y);
  add("front", {3, -1, 6.5}, -6.0 * x, 4.5 * y);
  add("right", {3, -1, -3}, 9.5 * z, 4.5 * y);
  if (!window) return add("left", {-3, -1, 6.5}, -9.5 * z, 4.5 * y);
  add("left, behind the window", {-3, -1, -1}, -2.0 * z, 4.5 * y);
  add("left, before the window", {-3, -1, 6.5}, -4.5 * z, 4.5 * y);
  add("left, below the window", {-3, -1, 2}, -3.0 * z, 1.5 * y);
  add("left, above the window", {-3, 2.8, 2}, -3.0 * z, 0.7 * y);
}

// Above the table: a glowing ball within a shell of glass, 3 mm thick.
void addBulb(std::vector<Object>& objects) {
  const dvec3 center(0.2, 1.9, 0.4);
  const auto inner = ball(center, 0.217);
  const auto shell = [&](const char* name, const Parametrisation& point) {
    objects.push_back({.name = name, .surface = tessellate(64, 32, point), .color = {1, 1, 1}});
    objects.back().glass = true;
  };
  shell("bulb, outside", ball(center, 0.22));
  shell("bulb, inside", [&](double u, double v) { return inner(1 - u, v); });
  objects.push_back({.name = "filament",
                     .surface = tessellate(32, 16, ball(center, 0.04)),
                     .color = {0, 0, 0},
                     .glow = 300});
}

// Makes all materials diffuse, except conductors (with a roughness that both renderers sample
// well), smooth glass or plastics, depending on `finish`.
void makePlain(std::vector<Object>& objects, Finish finish) {
  for (Object& object : objects) {
    const bool metal = object.metallic > 0, polished = metal && object.roughness < 0.3f;
    const bool conducts = metal && finish == Finish::Conductors;
    object.glow = 0;
    object.metallic = conducts;
    object.roughness = conducts                     ? std::max(object.roughness, 0.2f)
                       : finish == Finish::Plastics ? 0.3f
                                                    : 1;
    object.glass = polished && finish == Finish::Glass;
  }
  objects[0].color = {0.5f, 0.38f, 0.26f};  // the table, which has no texture here
}

// Planks along x: each with its own tone, grain stretched along it, dark joints between.
Image wood(int size) {
  Image image(size, size, 3);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const float px = 5.0f * float(x) / float(size), pz = 5.0f * float(y) / float(size) * 3;
      const float plank = std::floor(pz), across = pz - plank;
      const float warp = fractalNoise({0.7f * px + 17 * plank, 1.5f * pz, 3}, 3);
      const float grain = fractalNoise({1.3f * px + 9 * plank, 16 * pz + 14 * warp, 7}, 4);
      const float tone = 0.75f + 0.5f * valueNoise({plank * 7.3f, 0.5f, 0.5f});
      const float joint = glm::smoothstep(0.0f, 0.03f, std::min(across, 1 - across));
      const Rgb color = glm::mix(Rgb(0.115f, 0.055f, 0.027f), Rgb(0.36f, 0.2f, 0.105f), grain);
      image.setRgb(x, y, color * tone * (0.25f + 0.75f * joint));
    }
  return image;
}

}  // namespace

void writeStillLife(const std::string& path, Finish finish) {
  const bool caustics = finish == Finish::Caustics;
  std::vector<Object> objects = caustics ? causticBalls() : stillLife(finish == Finish::Fine);
  if (finish != Finish::Demo && !caustics) makePlain(objects, finish);
  if (finish == Finish::Room || finish == Finish::Lamp) addRoom(objects, finish == Finish::Room);
  if (finish == Finish::Lamp) addBulb(objects);

  GltfDocument glb;
  if (finish == Finish::Demo) objects[0].texture = addTexture(glb, wood(1024));
  for (Object& object : objects) {
    object.lambertian =
        finish != Finish::Demo && finish != Finish::Plastics && object.metallic == 0;
    addObject(glb, object);
  }
  writeScene(glb, "Front",
             Camera::lookAt({0.3f, 1.3f, 5.4f}, {0.05f, 0.62f, 0}, {0, 1, 0}, glm::radians(29.0f)),
             path);
}

}  // namespace chromeball::demo
