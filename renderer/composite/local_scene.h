// SPDX-License-Identifier: Apache-2.0
// The local scene (a model of real surfaces in the plate): which instances belong to it, its
// materials and its shape. All other instances are synthetic objects.
#pragma once

#include <optional>
#include <vector>

#include "base/text.h"
#include "composite/differential.h"
#include "scene/bounds.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace chromeball {

// The nodes in `names` and all their descendants are the local scene; all other instances are
// objects. Throws InputError for an unknown name (with the nearest known one), and if there are no
// objects (message beginning with `location`).
ObjectMask findObjects(const Scene& scene, const std::vector<NamedSetting>& names,
                       const std::string& location);

// Makes the base of the local scene's materials matte, with the base colour of `projection` where
// the camera sees them and the model's base colour elsewhere. Coats, sheen and transmission stay.
// The projection must outlive the scene; solveReflectance() fills it.
void makeProjected(Scene& scene, const ObjectMask& isObject, const Projection& projection);

// Gives the base of the local scene's materials a dielectric specular lobe (section 9.7.2):
// `strength` times the lobe of refractive index 1.5; `roughness` as in glTF. Coats, sheen and
// transmission stay.
void makeGlossy(Scene& scene, const ObjectMask& isObject, float strength, float roughness);

// Whether a material of the local scene has a coat, sheen or transmission.
bool isLayered(const Scene& scene, const ObjectMask& isObject);

// The unit normal of a flat local scene, with y >= 0; nullopt if it is not flat.
std::optional<vec3> flatNormal(const Scene& scene, const ObjectMask& isObject);

// The ground as a local scene that nobody has to model: a horizontal rectangle.

struct Ground {
  float height = 0;  // metres
  vec2 min, max;     // x and z
};

// The plane y = height, which extends on all sides to 30 times the sum of the size of the objects'
// box and their distance from the camera: the ground behind the camera lights the objects too, and
// what lies beyond is within 2 degrees of their horizon. Throws InputError, begun by `location`, if
// the camera is below the plane or does not see it.
Ground groundAround(const Camera& camera, float aspectRatio, const Bounds& objects, float height,
                    const std::string& location);

// The name of the node that addGround() adds, which no node of a model has.
inline constexpr const char* kGroundNode = "[composite] ground";

// The reflectance of a ground of which nothing is known.
inline constexpr Rgb kTypicalGround(0.25f);

// Adds the rectangle, matte. It lies lower by 1e-5 of the objects' size, so that surfaces of the
// model at its height are in front of it.
void addGround(Scene& scene, const Ground& ground, const Rgb& reflectance);

// Changes the base colour of an added ground.
void setGroundReflectance(Scene& scene, const Rgb& reflectance);

}  // namespace chromeball
