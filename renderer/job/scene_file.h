// SPDX-License-Identifier: Apache-2.0
// The scene file (TOML): which models, camera and probe make a picture, and how it is rendered.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/named_setting.h"
#include "scene/camera.h"
#include "scene/gltf/load_gltf.h"
#include "scene/lamp.h"
#include "scene/scene.h"
#include "scene/surroundings.h"

namespace chromeball {

struct ModelEntry {
  std::string file;
  // translation * rotation * scale. The file's `rotation` is three angles in degrees, about X, then
  // Y, then Z (fixed axes), or glTF's quaternion x, y, z, w; its `scale` is one number or three.
  Transform placement;
  GltfChoice choice;
};

// [composite]: objects of the model are put into a photograph.
struct CompositeEntry {
  std::string location;                  // of the section, for errors
  std::string plate;                     // the photograph
  std::vector<NamedSetting> localScene;  // nodes that stand for real things; the others are put in
  std::optional<NamedSetting> reflectance;   // of the local scene: "model", "plate" or "flat"
  std::optional<int> iterations;             // of "plate"; 1..20
  std::optional<float> specular, roughness;  // of the local scene's gloss; 0..1
  std::optional<NamedSetting> mode;          // "difference" or "ratio"
};

// Largest values of settings, the same on the command line.
inline constexpr uint32_t kMaxSamples = 2'000'000'000;
inline constexpr int kMaxDepth = 1'000'000;

// What the file says; what it leaves out is nullopt or empty, for the command line or the default
// to fill. File names are resolved against the scene file's folder.
struct SceneFile {
  std::vector<ModelEntry> models;  // at least one

  std::optional<NamedSetting> cameraName;  // a camera of the model; or
  std::optional<Camera> camera;  // [camera] position, look_at, up, fov (vertical, degrees) or
                                 // orthographic (height of the view, metres)
  struct Lens {
    float aperture, focus;  // diameter, and distance of the plane in focus: metres, > 0
    std::string location;   // for an error
  };
  std::optional<Lens> lens;  // for whichever camera it is

  std::optional<std::string> probe;
  std::optional<NamedSetting> probeMapping;
  std::optional<float> probeRotation;  // degrees
  std::optional<float> probeScale;     // >= 0

  std::optional<NamedSetting> strategy;  // NAME or NAME:COUNT
  std::optional<NamedSetting> mis;
  std::optional<float> modelLights;        // factor on the models' punctual lights; 0: off
  std::optional<NamedSetting> lightUnits;  // of the models: "photometric" or "radiometric"
  std::vector<Lamp> lamps;                 // [[light]]

  struct Size {
    int width, height;  // 1..65536
  };
  std::optional<Size> size;
  std::optional<uint32_t> samples;                    // 1..kMaxSamples, per pixel
  std::optional<int> maxDepth, maxTransmissionDepth;  // 0..kMaxDepth
  std::optional<NamedSetting> singleSided;            // "camera", "light" or "off"
  std::optional<uint64_t> seed;
  std::optional<double> timeLimit;   // seconds, > 0
  std::optional<double> noiseLimit;  // fraction, > 0 (the file states percent)

  std::optional<CompositeEntry> composite;
  std::optional<Surroundings> surroundings;

  std::vector<std::string> outputs;
  std::vector<NamedSetting> aovs;

  std::vector<std::string> warnings;  // "FILE:LINE: ...": what is allowed but seems a slip
};

// Throws InputError "FILE:LINE: ..." for what is not TOML, an unknown key (with the nearest known
// one), a wrong type, a number out of range, or a model or probe that does not exist.
SceneFile readSceneFile(const std::string& path);

}  // namespace chromeball
