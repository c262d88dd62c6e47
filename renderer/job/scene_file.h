// SPDX-License-Identifier: Apache-2.0
// The scene file (TOML): models, camera, probe, lights and settings of an image.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/named_setting.h"
#include "job/settings.h"
#include "scene/camera.h"
#include "scene/gltf/load_gltf.h"
#include "scene/lamp.h"
#include "scene/scene.h"
#include "scene/surroundings.h"

namespace chromeball {

struct ModelEntry {
  std::string file;
  Transform placement;  // translation * rotation * scale
  GltfChoice choice;
  glm::dvec3 translationRest{0};  // what float rounds off the translation
};

// The camera of a file, in world coordinates. It is rounded to float relative to the scene's
// origin.
struct CameraEntry {
  glm::dvec3 position, target;
  vec3 up;
  Camera lens;           // all but the place
  std::string location;  // FILE:LINE, begins an error

  // Throws InputError if position and target coincide or if up is parallel to the view.
  Camera relativeTo(const glm::dvec3& origin) const;
};

// [surroundings], likewise.
struct SurroundingsEntry {
  Surroundings shape;  // all but the places
  glm::dvec3 min{0}, max{0}, center{0}, capture{0};

  Surroundings relativeTo(const glm::dvec3& origin) const;
};

// A thin lens; applies to any perspective camera.
struct Lens {
  float aperture, focus;  // diameter, and distance of the plane in focus: metres, > 0
  std::string location;   // FILE:LINE, begins an error
};

// What distinguishes the image of a real lens from a pinhole's; applies to any perspective camera.
struct Optics {
  std::optional<vec2> principalPoint;  // Camera::principalPoint
  Distortion distortion;
  std::string location;  // FILE:LINE, begins an error
};

// The local scene of [composite], by node names; all other nodes are objects.
struct CompositeEntry {
  std::string location;  // of the section: FILE:LINE, begins an error
  std::vector<NamedSetting> localScene;
  Rgb groundReflectance{0.25f};
  vec2 groundReflectanceRange{0.1f, 0.5f};
};

// A polygon of the probe that becomes a source of its own ([[source]]).
struct SourceEntry {
  std::string name, location;       // location: FILE:LINE, begins an error
  std::vector<glm::dvec2> corners;  // positions in the probe's image, in pixels from its top left
  bool isIllum = true;
};

// The rotation of the probe at a time (`rotation_keys`).
struct ProbeTurn {
  double seconds;
  std::vector<double> rotation;  // as the setting "probe.rotation"
};

// The contents of a scene file. Paths are resolved against the scene file's folder.
struct SceneFile {
  std::string path;                // of the scene file, or of the model if there is no scene file
  std::vector<ModelEntry> models;  // at least one
  Settings settings;               // the given keys, except those of structured parts
  std::optional<CameraEntry> camera;  // [camera] with `position`, or of another file
  std::vector<ProbeTurn> probeTurns;  // ascending, may be empty
  std::optional<Lens> lens;
  std::optional<Optics> optics;
  std::vector<Lamp> lamps;              // [[light]]
  std::vector<SourceEntry> sources;     // [[source]]
  std::vector<std::string> lightLists;  // files that lamps and sources are from
  std::optional<CompositeEntry> composite;
  std::optional<std::string> plateScale;  // location of `[probe] scale = "plate"`
  std::optional<SurroundingsEntry> surroundings;
  std::vector<std::string> warnings;  // "FILE:LINE: ...": allowed, but probably a mistake
};

// Throws InputError "FILE:LINE: ..." for a file that is not TOML, an unknown key (with the nearest
// known one), a wrong type, a value out of range, or a model or probe that does not exist.
SceneFile readSceneFile(const std::string& path);

// A scene file (.toml), or a model (.gltf, .glb, or with their contents under another name) as a
// scene file that contains only this model.
// Throws InputError.
SceneFile openScene(const std::string& path);

}  // namespace chromeball
