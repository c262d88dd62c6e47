// SPDX-License-Identifier: Apache-2.0
// The parts of a scene that a description places in the world, in double precision: they are
// rounded to float relative to the scene's origin.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/camera.h"
#include "scene/gltf/load_gltf.h"
#include "scene/light.h"
#include "scene/surroundings.h"

namespace chromeball {

// Where the values of a description are from, for messages.

// "sources[2]": the name of an entry of an array of the description.
inline std::string elementName(std::string_view array, size_t index) {
  return std::string(array) + "[" + std::to_string(index) + "]";
}

// Where values come from, such as "scene.toml:12" or "--samples". They are found by their names in
// the table of settings ("render.samples") or by their places in RenderDescription ("camera.lens",
// "sources[2]"). The origin of a value from memory is its name.
class Origins {
 public:
  void set(const std::string& name, const std::string& location) { locations_[name] = location; }

  // Whether someone has given the value; else it is a default, or a program's.
  bool has(std::string_view name) const { return locations_.contains(name); }
  std::string of(std::string_view name) const {
    const auto found = locations_.find(name);
    return found == locations_.end() || found->second.empty() ? std::string(name) : found->second;
  }

 private:
  std::map<std::string, std::string, std::less<>> locations_;
};

// The parts of a scene.

struct ModelEntry {
  std::string file;
  Transform placement;  // translation * rotation * scale
  GltfChoice choice;
  glm::dvec3 translationRest{0};  // the part of the translation that float rounds off
};

// The camera of a file, in world coordinates. It is rounded to float relative to the scene's
// origin.
struct CameraEntry {
  glm::dvec3 position, target;
  vec3 up;
  // Its field of view or, if it is orthographic, its height. (Aperture, principal point and
  // distortion: Lens, Optics.)
  Camera lens = {};

  // Throws InputError if position and target coincide or if up is parallel to the view.
  Camera relativeTo(const glm::dvec3& origin) const {
    Camera camera = Camera::lookAt(vec3(position - origin), vec3(target - origin), up, lens.fov);
    camera.orthographic = lens.orthographic;
    camera.halfHeight = lens.halfHeight;
    return camera;
  }
};

// [surroundings], in world coordinates too.
struct SurroundingsEntry {
  Surroundings shape;  // all but the places
  glm::dvec3 min{0}, max{0}, center{0}, capture{0};

  Surroundings relativeTo(const glm::dvec3& origin) const {
    Surroundings s = shape;
    s.min = vec3(min - origin), s.max = vec3(max - origin);
    s.center = vec3(center - origin);
    s.capture = vec3(capture - origin);
    return s;
  }
};

// A thin lens; applies to any perspective camera.
struct Lens {
  float aperture, focus;  // diameter, and distance of the plane in focus: metres, > 0
};

// The differences of a real lens's image from a pinhole's; applies to any perspective camera.
struct Optics {
  std::optional<vec2> principalPoint;  // Camera::principalPoint
  Distortion distortion;
};

// The local scene of [composite], by node names; all other nodes are objects.
struct CompositeEntry {
  std::vector<std::string> localScene;
  std::optional<Rgb> groundReflectance;  // nullopt: typical, or by the plate (composite/plate.h)
  vec2 groundReflectanceRange{0.1f, 0.5f};
  std::optional<vec4> groundInPlate;  // left, top, right, bottom: fractions of the plate
};

// A polygon of the probe that becomes a source of its own ([[source]]).
struct SourceEntry {
  std::string name;
  std::vector<glm::dvec2> corners;  // positions in the probe's image, in pixels from its top left
  bool isIllum = true;
};

// What a scene file and the description made from it have in common.
struct SceneParts {
  std::string path;                  // of the scene file, or of the model if there is none
  std::vector<ModelEntry> models;    // at least one, unless a description has a scene from memory
  std::vector<Lamp> lamps;           // [[light]]
  std::vector<SourceEntry> sources;  // [[source]]
  std::vector<std::string> lightLists;  // files that lamps and sources are from
  std::optional<SurroundingsEntry> surroundings;
  std::string quality;  // the preset, and the settings that are by it; empty: none
  Origins origins;
  std::vector<std::string> warnings;  // "FILE:LINE: ...": allowed, but probably a mistake
};

}  // namespace chromeball
