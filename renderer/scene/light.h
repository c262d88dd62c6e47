// SPDX-License-Identifier: Apache-2.0
// Lights that are not emissive surfaces of a model, and their units in files.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "math/vec.h"
#include "probe/sun_extraction.h"
#include "scene/motion.h"

namespace chromeball {

// The conversion of a file's candela and lux to W/sr and W/m^2: Photometric divides by 683 lm/W, as
// Blender's exporter and importer do; Radiometric takes the numbers as W/sr and W/m^2.
enum class LightUnits : uint8_t { Photometric, Radiometric };

constexpr float lumensPerWatt(LightUnits units) {
  return units == LightUnits::Photometric ? 683.0f : 1.0f;
}

// The pose of a punctual light while the shutter is open (scene/motion.h).
struct LampPose {
  vec3 position, direction;
  bool operator==(const LampPose&) const = default;
};

struct PunctualLight {
  enum class Kind : uint8_t { Directional, Point, Spot };

  Kind kind = Kind::Point;
  Rgb intensity{
      1};  // W/sr; for a directional light W/m^2, its irradiance on a surface that faces it
  vec3 position{0};          // metres
  vec3 direction{0, 0, -1};  // unit, from the light into the scene
  float range = INFINITY;    // metres; beyond it the light is 0
  // A spot's cones, as coneOf() of their angles: full light inside, none outside.
  float innerCone = 0, outerCone = 0.29289322f;
  std::string name = {};  // of its node
  int node = -1;          // index into Scene::nodeNames; -1: none
  std::shared_ptr<const std::vector<LampPose>> motion = nullptr;  // its keys; null: stands still

  LampPose poseAt(float time) const {
    if (!motion) return {position, direction};
    const KeySpan span = keysAround(motion->size(), time);
    const LampPose &from = (*motion)[span.from], &to = (*motion)[span.to];
    return {glm::mix(from.position, to.position, span.fraction),
            glm::normalize(glm::mix(from.direction, to.direction, span.fraction))};
  }

  bool operator==(const PunctualLight&) const = default;

  // W/sr of a lamp with a power of 1 W: 1 / (integral of its falloff over all directions). A spot's
  // falloff is 1 within the inner cone and ((cos - cosOuter) / (cosInner - cosOuter))^2 between the
  // cones, whose cosines are 1 - innerCone and 1 - outerCone.
  float intensityOfOneWatt() const {
    if (kind == Kind::Point) return 1 / (4 * kPi);
    return 1 / (2 * kPi * (innerCone + (outerCone - innerCone) / 3));
  }
};

// 1 - cos of an angle in radians, so that narrow cones keep their digits.
inline float coneOf(double angle) {
  const double sine = std::sin(angle / 2);
  return float(2 * sine * sine);
}

// A disc that emits uniform radiance from one side.
struct DiscLamp {
  vec3 direction{0, 0, -1};  // unit, the normal of the emitting side
  float radius = 1;          // metres
  Rgb radiance{1};
};

// A distant disc.
struct SunLamp {
  Sun sun;
  bool isVisible = true;  // to the camera and mirrors
  std::string name = {};
};

// Constant radiance from all directions.
struct AmbientLamp {
  Rgb radiance{0};
  bool isVisible = true;  // to the camera and mirrors
  std::string name = {};
};

// Lamps that a scene file adds to the models ([[light]]).

// Exactly one of `punctual`, `disc`, `sun` and `ambient` is set.
struct Lamp {
  std::string name;  // of its node
  // The position of a punctual light or disc in the world, metres; their own one is not used.
  glm::dvec3 position{0};
  std::optional<PunctualLight> punctual;
  std::optional<DiscLamp> disc;
  std::optional<SunLamp> sun;
  std::optional<AmbientLamp> ambient;
};

}  // namespace chromeball
