// SPDX-License-Identifier: Apache-2.0
#include "gallery.h"
#include "glb_objects.h"
#include "stone.h"
#include "turned.h"

namespace chromeball::demo {
namespace {

// Plinth, moulding, drum, moulding and table of the pedestal.
const Profile kPedestalCorners = {{0, 0},       {1.5, 0},     {1.5, 0.22},  {1.36, 0.24},
                                  {1.32, 0.36}, {1.16, 0.42}, {1.1, 1.0},   {1.24, 1.1},
                                  {1.28, 1.2},  {1.42, 1.22}, {1.42, 1.36}, {0, 1.36}};
const Profile kPedestal = filleted(kPedestalCorners, 0.03, 0.08);

// A stand whose cup's rim, of radius 0.62 of the ball's, is at height 1.
const Profile kStandCorners = {{0, 0},        {0.2, 0},     {0.2, 0.025},  {0.1, 0.06},
                               {0.035, 0.14}, {0.028, 0.4}, {0.055, 0.46}, {0.028, 0.52},
                               {0.03, 0.86},  {0.09, 0.93}, {0.12, 1.0},   {0.1, 1.0},
                               {0, 0.94}};
const Profile kStand = filleted(kStandCorners, 0.012);

// The balls around the pedestal, by bearing.
const std::vector<Object> kBalls = {
    {.name = "silver", .color = Rgb(0.95f, 0.93f, 0.88f), .metallic = 1, .roughness = 0},
    {.name = "red plastic", .color = {0.5f, 0.018f, 0.02f}, .roughness = 0.08f},
    {.name = "brushed steel",
     .color = {0.58f, 0.57f, 0.56f},
     .metallic = 1,
     .roughness = 0.22f,
     .anisotropy = 0.85f},
    {.name = "clear glass", .color = Rgb(1), .glass = true},
    {.name = "gold", .color = {1, 0.71f, 0.29f}, .metallic = 1, .roughness = 0.06f},
    {.name = "porcelain", .color = {0.75f, 0.73f, 0.68f}, .roughness = 0.3f, .clearcoat = 1},
    {.name = "green glass", .color = {0.25f, 0.8f, 0.5f}, .glass = true},
    {.name = "copper",
     .color = {0.93f, 0.52f, 0.36f},
     .metallic = 1,
     .roughness = 0.3f,
     .anisotropy = 0.7f},
    {.name = "blue lacquer", .color = {0.015f, 0.06f, 0.3f}, .roughness = 0.5f, .clearcoat = 1},
    {.name = "black plastic", .color = Rgb(0.012f), .roughness = 0.12f},
};

Object ballOf(Object object, dvec3 center, double radius) {
  object.surface = tessellate(128, 64, ball(center, radius), Uvs::Parameters);
  return object;
}

Object carved(GltfDocument& glb, const char* name, int columns, const Profile& profile,
              const SolidTexture& stone, const ImageSize& size) {
  Object object{.name = name,
                .surface = tessellateTurned(columns, dvec3(0), profile),
                .color = {1, 1, 1},
                .roughness = 0.25f};
  object.texture = addTexture(glb, carve(size, turned(dvec3(0), profile), stone));
  return object;
}

}  // namespace

void writePedestal(const std::string& path) {
  GltfDocument glb;
  const SolidTexture white = marble({0.72f, 0.69f, 0.64f}, {0.24f, 0.23f, 0.24f}, 0.9f);
  addObject(glb, carved(glb, "pedestal", 160, kPedestal, white, {2048, 1536}));

  const int stand = addMesh(glb, {.name = "stand",
                                  .surface = tessellateTurned(48, dvec3(0), kStand),
                                  .color = {0.42f, 0.27f, 0.15f},
                                  .metallic = 1,
                                  .roughness = 0.28f});
  const double top = kPedestal.back().y;
  for (size_t i = 0; i < kBalls.size(); ++i) {
    const double bearing = 2 * kPiD * (double(i) + 0.5) / double(kBalls.size());
    const double height = i % 2 ? 0.34 : 0.62, radius = 0.2;
    const dvec3 foot = dvec3(1.08 * std::sin(bearing), top, 1.08 * std::cos(bearing));
    addNode(glb, "stand", stand, {.position = vec3(foot), .scale = vec3(1, float(height), 1)});
    // The ball touches the rim of its cup: radius 0.12 there, less what its curve needs.
    const double sunk = std::sqrt(radius * radius - 0.12 * 0.12);
    addObject(glb, ballOf(kBalls[i], foot + dvec3(0, height + sunk + 1e-3, 0), radius));
  }
  addNode(glb, "stand", stand, {.position = vec3(0, top, 0), .scale = vec3(2.4f, 0.5f, 2.4f)});
  addObject(glb,
            ballOf({.name = "great glass", .color = Rgb(1), .glass = true},
                   dvec3(0, top + 0.5 + std::sqrt(0.52 * 0.52 - 0.288 * 0.288) + 1e-3, 0), 0.52));
  writeScene(glb, "View",
             Camera::lookAt({0.5f, 2.6f, 6.2f}, {0, 1.62f, 0}, {0, 1, 0}, glm::radians(27.0f)),
             path);
}

}  // namespace chromeball::demo
