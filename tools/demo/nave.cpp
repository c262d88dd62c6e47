// SPDX-License-Identifier: Apache-2.0
#include "gallery.h"

#include <array>

#include "flat.h"
#include "glb_objects.h"
#include "stone.h"
#include "turned.h"

namespace chromeball::demo {
namespace {

const NaveMeasures kNave;
constexpr float kTexture = 4, kSpring = 4.4f, kAisleWall = 6.4f;
constexpr int kCoffersAcross = 9, kCofferSteps = 8;
constexpr int kApsePanels = 45;  // of its wall; the conch above has the same corners

// The arcade on one side, with the clerestory above; fronts face the nave.
void addSide(Surface& s, float side) {
  const float front = side * kNave.halfWidth, length = kNave.halfLength();
  for (int i = 0; i < kNave.bays; ++i) {
    // Left to right as seen from the front.
    const float start = side < 0 ? length - kNave.bay * float(i) : -length + kNave.bay * float(i);
    const vec3 along(0, 0, side < 0 ? -kNave.bay : kNave.bay);
    const auto wall = [&](float x, float low, float high, const Opening& opening) {
      addWall(s, {{x, low, start}, along, high - low, kNave.wall}, opening, kTexture);
    };
    wall(front, kSpring, kNave.clerestory, {1.95f, 0, 0});
    wall(front, kNave.clerestory, kNave.springOfVault,
         {kNave.windowHalfWidth, kNave.windowSill, kNave.windowSpring});
    wall(side * kNave.aisle, 0, kAisleWall, {0.75f, 2.2f, 4.3f});
  }
  // The surfaces that rest on the capitals, and the aisle's roof.
  for (int i = 0; i <= kNave.bays; ++i) {
    const float z = -length + kNave.bay * float(i);
    const float low = std::max(z - 0.55f, -length), high = std::min(z + 0.55f, length);
    addQuad(s, {std::min(front, front + side * kNave.wall), kSpring, low}, {kNave.wall, 0, 0},
            {0, 0, high - low}, kTexture);
  }
  const vec3 inner(front + side * kNave.wall, kNave.clerestory, side * length);
  addQuad(s, inner, {side * kNave.aisle - inner.x, kAisleWall - inner.y, 0}, {0, 0, -2 * inner.z},
          kTexture);
}

// The ends of nave and aisles: an arch to the apse, and a round window high in the west.
void addEnds(Surface& s) {
  const float x = kNave.halfWidth, out = kNave.aisle, z = kNave.halfLength();
  addWall(s, {{-x, 0, -z}, {2 * x, 0, 0}, kNave.springOfVault, kNave.wall},
          {kNave.apse, 0, kNave.apseSpring}, kTexture);
  addWall(s, {{x, 0, z}, {-2 * x, 0, 0}, kNave.springOfVault, kNave.wall}, {1.6f, 6.6f, 9.2f},
          kTexture);
  std::vector<vec3> lunette;
  constexpr int kSegments = kCoffersAcross * kCofferSteps;  // as the vault
  for (int i = 0; i <= kSegments; ++i) {
    const float angle = kPi * float(i) / kSegments;
    lunette.push_back({x * std::cos(angle), kNave.springOfVault + x * std::sin(angle), -z});
  }
  addPolygon(s, lunette, kTexture);
  std::ranges::reverse(lunette);
  for (vec3& p : lunette) p.z = z;
  addPolygon(s, lunette, kTexture);
  for (const float side : {-1.0f, 1.0f}) {
    const float a = side < 0 ? -out : x, b = side < 0 ? -x : out;
    const float heightA = side < 0 ? kAisleWall : kNave.clerestory + 0.4f;
    const float heightB = side < 0 ? kNave.clerestory + 0.4f : kAisleWall;
    addPolygon(
        s, std::array{vec3(a, 0, -z), vec3(b, 0, -z), vec3(b, heightB, -z), vec3(a, heightA, -z)},
        kTexture);
    addPolygon(s,
               std::array{vec3(b, 0, z), vec3(a, 0, z), vec3(a, heightA, z), vec3(b, heightB, z)},
               kTexture);
  }
}

// Half a cylinder of flat panels; three windows are three panels wide.
void addApse(Surface& s) {
  const auto at = [](int i, float y) {
    const float angle = kPi * (1 - float(i) / kApsePanels);
    return vec3(kNave.apse * std::cos(angle), y,
                -kNave.halfLength() - kNave.wall - kNave.apse * std::sin(angle));
  };
  for (int i = 0; i < kApsePanels; ++i) {
    const auto part = [&](float low, float high) {
      addPolygon(s, std::array{at(i, low), at(i + 1, low), at(i + 1, high), at(i, high)}, kTexture);
    };
    const bool window = i / 3 == 4 || i / 3 == 7 || i / 3 == 10;
    part(0, window ? 3.6f : kNave.apseSpring);
    if (window) part(7.4f, kNave.apseSpring);
  }
}

// A quarter of a sphere that faces its centre.
Surface conch() {
  const dvec3 center(0, kNave.apseSpring, -kNave.halfLength() - kNave.wall);
  const auto point = [=](double u, double v) {
    const double bearing = kPiD * u, height = kPiD / 2 * v;  // from -x over -z to +x
    return center + double(kNave.apse) * dvec3(-std::cos(bearing) * std::cos(height),
                                               std::sin(height),
                                               -std::sin(bearing) * std::cos(height));
  };
  return tessellate(kApsePanels, 24, point, Uvs::Parameters);
}

// The vault, with coffers sunk into it: faces down.
Surface vault() {
  constexpr int kAlong = 21;
  return tessellate(
      kCoffersAcross * kCofferSteps, kAlong * kCofferSteps,
      [](double u, double v) {
        const auto edge = [](double t) {
          return 2 * std::abs(t - std::floor(t) - 0.5);
        };  // 1 on a rib
        const double rib = std::max(edge(kCoffersAcross * u), edge(kAlong * v));
        const double depth = 0.3 * (1 - glm::smoothstep(0.62, 0.8, rib));
        const double angle = kPiD * u, radius = kNave.halfWidth + depth;
        return dvec3(-radius * std::cos(angle), kNave.springOfVault + radius * std::sin(angle),
                     kNave.halfLength() * (2 * v - 1));
      },
      Uvs::Parameters);
}

Surface column() {
  const Profile corners = {{0.56, 0},    {0.56, 0.16}, {0.46, 0.2},  {0.5, 0.27},
                           {0.4, 0.34},  {0.415, 1.6}, {0.345, 3.7}, {0.38, 3.73},
                           {0.35, 3.78}, {0.48, 4.08}, {0.5, 4.16}};
  Surface s = tessellateTurned(48, dvec3(0), filleted(corners, 0.02));
  addClosedBox(s, {-0.6f, 0, -0.6f}, {0.6f, 0.06f, 0.6f}, kTexture);
  addClosedBox(s, {-0.55f, 4.16f, -0.55f}, {0.55f, kSpring, 0.55f}, kTexture);
  return s;
}

// Squares of two marbles.
Rgb pavement(const vec3& p) {
  static const SolidTexture light = marble({0.58f, 0.54f, 0.47f}, {0.3f, 0.26f, 0.22f}, 2.2f);
  static const SolidTexture dark = marble({0.16f, 0.09f, 0.07f}, {0.45f, 0.38f, 0.33f}, 1.7f);
  const float x = p.x / 1.25f, z = p.z / 1.25f;
  const bool odd = (int(std::floor(x)) + int(std::floor(z))) & 1;
  const float edge = std::min(std::abs(x - std::round(x)), std::abs(z - std::round(z)));
  const vec3 tile(7 * std::floor(x), 0, 5 * std::floor(z));  // no vein crosses a joint
  return (odd ? dark : light)(p + tile) * (0.6f + 0.4f * glm::smoothstep(0.0f, 0.008f, edge));
}

Parametrisation floorPlane() {
  const double x = kNave.aisle + 1, front = kNave.halfLength(),
               back = front + kNave.wall + kNave.apse;
  return patch({-x, 0, front}, {2 * x, 0, 0}, {0, 0, -front - back});
}

Object stone(const char* name, Surface surface, Rgb color) {
  return {.name = name, .surface = std::move(surface), .color = color, .lambertian = true};
}

void addFloor(GltfDocument& glb) {
  Object floor{.name = "floor",
               .surface = tessellate(2, 2, floorPlane(), Uvs::Parameters),
               .color = {1, 1, 1},
               .roughness = 0.16f};
  floor.texture = addTexture(glb, carve({1536, 2816}, floorPlane(), pavement));
  addObject(glb, floor);
}

void addRoom(GltfDocument& glb) {
  Surface walls;
  for (const float side : {-1.0f, 1.0f}) addSide(walls, side);
  addEnds(walls);
  addApse(walls);
  Object plaster = stone("walls", walls, {1, 1, 1});
  plaster.texture = addTexture(glb, ashlar(1024, 4, 8, {0.7f, 0.63f, 0.52f}));
  addObject(glb, plaster);
  addObject(glb, stone("vault", vault(), {0.66f, 0.6f, 0.5f}));
  addObject(glb, stone("conch", conch(), {0.62f, 0.45f, 0.2f}));
  const int shaft = addMesh(
      glb,
      {.name = "column", .surface = column(), .color = {0.5f, 0.42f, 0.36f}, .roughness = 0.3f});
  for (int i = 0; i <= kNave.bays; ++i)
    for (const float side : {-1.0f, 1.0f})
      addNode(glb, "column", shaft,
              {.position = {side * (kNave.halfWidth + kNave.wall / 2), 0,
                            -kNave.halfLength() + kNave.bay * float(i)}});
}

void addThings(GltfDocument& glb) {
  const auto slab = [](dvec3 foot, dvec3 half, double turn) {
    Surface s;
    addClosedBox(s, vec3(-half.x, 0, -half.z), vec3(half.x, 2 * half.y, half.z), 1);
    const mat3 turned = glm::mat3_cast(glm::angleAxis(float(turn), vec3(0, 1, 0)));
    for (vec3& p : s.positions) p = turned * p + vec3(foot);
    for (vec3& n : s.normals) n = turned * n;
    return s;
  };
  const auto monolith = [&](dvec3 foot, double turn) {
    addObject(glb, {.name = "monolith",
                    .surface = slab(foot, {0.55, 1.6, 0.16}, turn),
                    .color = Rgb(0.012f),
                    .roughness = 0.08f});
  };
  monolith({-2.7, 0, 3.2}, 0.5);
  monolith({-0.9, 0, -3.6}, 0.1);
  monolith({2.6, 0, 0.4}, -0.5);
  const auto sphere = [&](const char* name, vec3 center, float radius, Rgb color, float metallic,
                          float roughness, bool glass = false) {
    addObject(glb, {.name = name,
                    .surface = tessellate(128, 64, ball(center, radius), Uvs::Parameters),
                    .color = color,
                    .metallic = metallic,
                    .roughness = roughness,
                    .glass = glass});
  };
  sphere("steel", {0.6f, 0.75f, 3.4f}, 0.75f, Rgb(0.82f), 1, 0.01f);
  sphere("gold", {-1.45f, 0.42f, 4.7f}, 0.42f, {1, 0.71f, 0.29f}, 1, 0.16f);
  sphere("plaster", {2.2f, 0.5f, 3.6f}, 0.5f, Rgb(0.75f), 0, 0.9f);
  sphere("steel", {-2.2f, 0.6f, 0.2f}, 0.6f, Rgb(0.82f), 1, 0.01f);
  sphere("glass", {1.35f, 0.301f, 5.4f}, 0.3f, Rgb(1), 0, 0, true);
}

}  // namespace

void writeNave(const std::string& path, Nave what) {
  GltfDocument glb;
  addFloor(glb);
  if (what != Nave::Things) addRoom(glb);
  if (what != Nave::Room) addThings(glb);
  writeScene(glb, "View",
             Camera::lookAt({0.7f, 1.7f, 12.8f}, {0, 3.9f, 0}, {0, 1, 0}, glm::radians(52.0f)),
             path);
}

}  // namespace chromeball::demo
