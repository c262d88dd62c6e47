// SPDX-License-Identifier: Apache-2.0
// The scene file (TOML): models, camera, probe, lights and settings of an image.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "description/scene_entries.h"
#include "front/settings.h"

namespace chromeball {

// The rotation of the probe at a time (`rotation_keys`).
struct ProbeTurn {
  double seconds;
  std::vector<double> rotation;  // as the setting "probe.rotation"
  std::string location;
};

// The contents of a scene file. Paths are resolved against the scene file's folder.
struct SceneFile : SceneParts {
  Settings settings;                  // the given keys, except those of structured parts
  std::optional<CameraEntry> camera;  // [camera] with `position`, or of another file
  std::vector<ProbeTurn> probeTurns;  // ascending, may be empty
  std::optional<Lens> lens;
  std::optional<Optics> optics;
  std::optional<CompositeEntry> composite;
  std::optional<std::string> plateScale;  // location of `[probe] scale = "plate"`
};

// Throws InputError "FILE:LINE: ..." for a file that is not TOML, an unknown key (with the nearest
// known one), a wrong type, a value out of range, or a model or probe that does not exist.
SceneFile readSceneFile(const std::string& path);

// A scene file (.toml), or a model (.gltf, .glb, or with their contents under another name) as a
// scene file that contains only this model.
// Throws InputError.
SceneFile openScene(const std::string& path);

// `over` replaces settings of the file, among them those that it stores with models, camera and
// composite. Throws InputError for settings that exclude each other.
void overrideSettings(SceneFile& file, const Settings& over);

}  // namespace chromeball
