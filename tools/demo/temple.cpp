// SPDX-License-Identifier: Apache-2.0
// A peripteral temple of 8 by 17 columns about a cella with porches of six.
#include <array>

#include "doric.h"
#include "flat.h"
#include "gallery.h"
#include "glb_objects.h"
#include "stone.h"
#include "texels.h"

namespace chromeball::demo {
namespace {

constexpr int kFront = 8, kFlank = 17;
constexpr float kSpacing = 4.3f, kTempleTexture = 6;
constexpr float kHalfWidth = kSpacing * (kFront - 1) / 2, kHalfLength = kSpacing * (kFlank - 1) / 2;
constexpr float kStep = 0.52f, kFloor = 3 * kStep;  // the stylobate's height above the ground
const DoricColumn kColumn;
const float kTop = kFloor + float(kColumn.height);  // where the architrave starts
constexpr float kArchitrave = 1.35f, kFrieze = 1.35f, kCornice = 0.55f, kBeam = 0.85f;
constexpr float kCeiling = kArchitrave + kFrieze;  // above kTop: what the cornice covers
constexpr float kPorch = 28;                       // from the middle to the columns of a porch
constexpr Rgb kMarble(0.72f, 0.65f, 0.54f);

// A box about the middle: half its width and length, its lower and upper height.
void addLayer(Surface& s, float beyond, float low, float high) {
  addClosedBox(s, {-kHalfWidth - beyond, low, -kHalfLength - beyond},
               {kHalfWidth + beyond, high, kHalfLength + beyond}, kTempleTexture);
}

// A beam along the four rows of columns.
void addRing(Surface& s, float half, float low, float high) {
  const float x = kHalfWidth, z = kHalfLength;
  for (const float side : {-1.0f, 1.0f}) {
    addClosedBox(s, {side * x - half, low, -z - half}, {side * x + half, high, z + half},
                 kTempleTexture);
    addClosedBox(s, {-x + half, low, side * z - half}, {x - half, high, side * z + half},
                 kTempleTexture);
  }
}

Surface masonry() {
  Surface s;
  for (int step = 0; step < 3; ++step)
    addLayer(s, 1.15f + 0.7f * float(2 - step), kStep * float(step), kStep * float(step + 1));
  addRing(s, kBeam, kTop, kTop + kArchitrave - 0.12f);
  addRing(s, kBeam + 0.06f, kTop + kArchitrave - 0.12f, kTop + kArchitrave);
  addRing(s, kBeam - 0.04f, kTop + kArchitrave, kTop + kArchitrave + kFrieze);
  const float cornice = kTop + kCeiling;
  addLayer(s, kBeam + 0.25f, cornice, cornice + 0.16f);
  addLayer(s, kBeam + 0.75f, cornice + 0.16f, cornice + kCornice);
  return s;
}

// Walls from floor to ceiling, with a door behind each porch, whose columns carry a beam.
Surface cella() {
  constexpr float kWide = 10.2f, kLong = 23.6f, kThick = 1.1f, kDoor = 2.4f, kLintel = kFloor + 8;
  const float top = kTop + kCeiling;
  Surface s;
  addClosedBox(s, {-kWide - 0.4f, kFloor, -kLong - 5.4f},
               {kWide + 0.4f, kFloor + 0.35f, kLong + 5.4f}, kTempleTexture);
  for (const float z : {kLong - kThick, -kLong}) {
    addClosedBox(s, {-kWide + kThick, kFloor, z}, {-kDoor, top, z + kThick}, kTempleTexture);
    addClosedBox(s, {kDoor, kFloor, z}, {kWide - kThick, top, z + kThick}, kTempleTexture);
    addClosedBox(s, {-kDoor, kLintel, z}, {kDoor, top, z + kThick}, kTempleTexture);
  }
  for (const float x : {-kWide, kWide - kThick})
    addClosedBox(s, {x, kFloor, -kLong - 0.9f}, {x + kThick, top, kLong + 0.9f}, kTempleTexture);
  for (const float z : {-kPorch, kPorch})
    addClosedBox(s, {-kWide - 0.8f, kTop, z - 0.75f}, {kWide + 0.8f, top, z + 0.75f},
                 kTempleTexture);
  return s;
}

// The body of the gables, recessed, and two slopes that overhang it.
Surface roof() {
  constexpr float kSlope = 0.245f, kThick = 0.45f, kRecess = 0.95f;
  const float eaves = kTop + kCeiling + kCornice;
  const float x = kHalfWidth + kBeam + 0.75f, z = kHalfLength + kBeam + 0.75f;
  const vec2 right(x, eaves), left(-x, eaves), ridge(0, eaves + kSlope * x), thick(0, kThick);
  Surface s;
  addPrism(s, std::array{left, right, ridge}, vec2(-z, z) + vec2(kRecess, -kRecess),
           kTempleTexture);
  addPrism(s, std::array{right, right + thick, ridge + thick, ridge}, {-z, z}, kTempleTexture);
  addPrism(s, std::array{ridge, ridge + thick, left + thick, left}, {-z, z}, kTempleTexture);
  return s;
}

// Columns around, and six before each end of the cella, a step higher.
std::vector<Placement> columns() {
  std::vector<Placement> at;
  const auto add = [&](float x, float z) {
    at.push_back({.position = {x, kFloor, z}, .turn = 0.7f * float(at.size())});
  };
  for (int i = 0; i < kFlank; ++i)
    for (const float side : {-1.0f, 1.0f}) {
      const float z = -kHalfLength + kSpacing * float(i);
      add(side * kHalfWidth, z);
    }
  for (int i = 1; i + 1 < kFront; ++i)
    for (const float side : {-1.0f, 1.0f})
      add(-kHalfWidth + kSpacing * float(i), side * kHalfLength);
  constexpr float kPlinth = 0.35f, kShorter = 1 - kPlinth / 10.4f;
  for (int i = 1; i + 1 < kFront; ++i)
    for (const float side : {-1.0f, 1.0f})
      at.push_back({.position = {0.92f * (-kHalfWidth + kSpacing * float(i)), kFloor + kPlinth,
                                 side * kPorch},
                    .turn = 0.7f * float(at.size()),
                    .scale = {0.88f, kShorter, 0.88f}});
  return at;
}

// A triglyph over each column and in the middle between two.
std::vector<Placement> triglyphs() {
  std::vector<Placement> at;
  const float y = kTop + kArchitrave, out = kBeam - 0.06f;
  for (int i = 0; i <= 2 * (kFront - 1); ++i)
    for (const float side : {-1.0f, 1.0f})
      at.push_back(
          {.position = {-kHalfWidth + kSpacing / 2 * float(i), y, side * (kHalfLength + out)},
           .turn = side > 0 ? 0 : kPi});
  for (int i = 0; i <= 2 * (kFlank - 1); ++i)
    for (const float side : {-1.0f, 1.0f})
      at.push_back(
          {.position = {side * (kHalfWidth + out), y, -kHalfLength + kSpacing / 2 * float(i)},
           .turn = side * kPi / 2});
  return at;
}

// A rocky hill that falls to a plain, with mountains around: height at a place.
float terrain(float x, float z) {
  const vec3 p(x, 0, z);
  const float away =
      glm::length(vec2(std::max(std::abs(x) - 22, 0.0f), std::max(std::abs(z) - 42, 0.0f)));
  const float rough = glm::smoothstep(0.0f, 12.0f, away);
  const float hill = -28 * glm::smoothstep(30.0f, 260.0f, away);
  const float stones = 1.1f * (fractalNoise(0.16f * p, 5) - 0.5f);
  const float mountains = 900 * glm::smoothstep(900.0f, 4200.0f, away) *
                          std::max(fractalNoise(0.0011f * p + vec3(7, 0, 3), 6) - 0.38f, 0.0f);
  return rough * stones + hill + mountains - 0.02f;
}

// Around the temple a square of the same height field as the land beyond, with more detail.
constexpr double kNear = 110, kFar = 6000;

Parametrisation hill() {
  return [](double u, double v) {
    const double x = kNear * (2 * u - 1), z = kNear * (1 - 2 * v);
    return dvec3(x, terrain(float(x), float(z)), z);
  };
}

Parametrisation land() {
  return [](double u, double v) {
    const double radius = 0.95 * kNear * std::pow(kFar / kNear, v), angle = -2 * kPiD * u;
    const double x = radius * std::cos(angle), z = -radius * std::sin(angle);
    const float below = radius < 1.5 * kNear ? 0.3f : 0.0f;  // the square
    return dvec3(x, terrain(float(x), float(z)) - below, z);
  };
}

// Dry grass between bare stone; blue haze with the distance.
Rgb earth(const vec3& p) {
  const float bare = glm::smoothstep(0.42f, 0.6f, fractalNoise(0.12f * p, 5));
  const float grain = 0.55f + 0.9f * fractalNoise(1.7f * p, 6);
  const Rgb near = grain * glm::mix(Rgb(0.2f, 0.17f, 0.08f), Rgb(0.36f, 0.31f, 0.24f), bare);
  const float haze = 1 - std::exp(-glm::length(p) / 3500);
  return glm::mix(near, Rgb(0.15f, 0.18f, 0.23f), haze);
}

}  // namespace

void writeTemple(const std::string& path) {
  GltfDocument glb;
  const int blocks = addTexture(glb, ashlar(1024, 3, 6, kMarble));
  const int drums = addTexture(glb, ashlar(1024, 1, 10, kMarble));
  const auto stone = [&](const char* name, Surface surface, int texture) {
    return Object{.name = name,
                  .surface = std::move(surface),
                  .color = {1, 1, 1},
                  .texture = texture,
                  .lambertian = true};
  };
  addObject(glb, stone("masonry", masonry(), blocks));
  addObject(glb, stone("cella", cella(), blocks));
  addObject(glb, stone("roof", roof(), blocks));
  const int shaftMesh = addMesh(glb, stone("shaft", shaft(kColumn), drums));
  const int capitalMesh = addMesh(glb, stone("capital", capital(kColumn), blocks));
  for (const Placement& at : columns()) {
    addNode(glb, "shaft", shaftMesh, at);
    Placement square = at;
    square.turn = 0;
    addNode(glb, "capital", capitalMesh, square);
  }
  const int triglyphMesh = addMesh(glb, stone("triglyph", triglyph(0.84f, kFrieze), blocks));
  for (const Placement& at : triglyphs()) addNode(glb, "triglyph", triglyphMesh, at);
  addObject(glb, stone("hill", tessellate(120, 120, hill(), Uvs::Parameters),
                       addTexture(glb, carve({2048, 2048}, hill(), earth))));
  addObject(glb, stone("land", tessellate(128, 64, land(), Uvs::Parameters),
                       addTexture(glb, carve({1024, 512}, land(), earth))));
  writeScene(glb, "View",
             Camera::lookAt({-38, 1.7f, 82}, {-3.2f, 10, 20}, {0, 1, 0}, glm::radians(28.0f)),
             path);
}

}  // namespace chromeball::demo
