// SPDX-License-Identifier: Apache-2.0
// Everything that decides an image, as values.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/message.h"
#include "composite/layers.h"
#include "description/scene_entries.h"
#include "image/develop/develop.h"
#include "image/tonemap.h"
#include "math/rotation.h"
#include "probe/mapping.h"
#include "render/render_settings.h"
#include "scene/scene.h"

namespace chromeball {

class LightSource;
class Probe;

// The time that the image covers, beginning at its own time.
struct Shutter {
  double frames = 0, fps = 24;
  int steps = 8;    // straight pieces of each motion, up to kMostMotionSteps
  double turn = 0;  // of the camera's orbit, degrees

  double seconds() const { return frames / fps; }
};

struct CameraDescription {
  std::optional<CameraEntry> placed;  // nullopt: one of the models, or one that frames them
  std::optional<std::string> name;    // of the models'; nullopt: the first
  std::optional<std::string> file;    // that it was read from
  std::optional<Lens> lens;
  std::optional<Optics> optics;
  // Of the camera that frames the models; either makes it take the place of the models' cameras.
  std::optional<ViewAngles> view;   // nullopt: it suits their shape
  std::optional<std::string> node;  // that it frames; nullopt: all
  std::optional<double> fov;        // of any perspective camera, degrees; nullopt: its own
  double zoom = 1;                  // divides the size of what any camera shows
  double orbit = 0;                 // turn around the models, degrees
  bool turns = false;               // by `orbit` or while the shutter is open
  std::optional<Shutter> shutter;   // nullopt: an image of one instant

  bool frames() const { return view || node; }
};

// Where the models stand, other than by their own placements.
struct StandDescription {
  std::optional<double> turntable;  // turn about the vertical through their centre, degrees
  bool drops = false;               // their lowest point to the ground, or to height 0
  bool hasGround = false;           // a matte plane, which a shadow catcher has by its own choice
  std::optional<double> height;     // of the ground in the world, metres; nullopt: the lowest point

  bool movesModels() const { return turntable || drops; }
};

struct ProbeDescription {
  std::optional<std::string> file;   // nullopt: the models' own environment, or none
  std::shared_ptr<const Image> map;  // in place of a file: lat-long, radiance; null: none
  std::string mapping = "auto";      // of the file
  Rotation rotation;
  glm::dvec3 scale{1};
  bool isScaledByPlate = false;  // so that the ground of a composite looks as in the plate
};

// The part of the light that is rendered: the suns of the probe and of the scene file, or all the
// rest. Both together are the whole.
enum class LightFrom { All, Suns, Rest };

struct LightingDescription {
  std::string strategy = "auto";  // strategyNames()
  LightFrom from = LightFrom::All;
  double lamps = 1;                // factor on the models' punctual lights
  std::optional<double> sunAngle;  // StrategyOptions::sunAngle
  bool showLights = false;         // StrategyOptions::showLights
  // A program's own strategy, which takes the place of the named one; empty: none. The probe
  // outlives the strategy that it makes. `strategy` names it in headers and identities. `origin`:
  // of LightPoint::position in the world, metres.
  std::function<std::unique_ptr<LightSource>(const Probe&, const glm::dvec3& origin)> make = {};
};

struct CompositeDescription {
  CompositeEntry entry;
  std::optional<std::string> plateFile;  // nullopt: a shadow catcher
  Image plate;                           // of the image's size
  bool isPhotograph = false;             // the plate's file holds integers: its white is 1
  CompositeMode mode = CompositeMode::Difference;
  // The source of the local scene's reflectance.
  enum class Reflectance { Model, Plate, Flat } reflectance = Reflectance::Model;
  bool choosesReflectance = false;  // Flat may become Plate
  int iterations = 1;               // of Reflectance::Plate
  Passes passes = Passes::One;
  std::vector<std::string> layers;  // names of all that were requested
  // A plane under the models: always, or where the local scene names `ground` and the models do
  // not.
  enum class GroundPlane { Never, Always, IfNamed } ground = GroundPlane::Never;
  double groundHeight = 0;                    // in the world, metres
  std::optional<double> specular, roughness;  // of the local scene's gloss; neither: it has none
  Messages messages;                          // of the plate's reader
};

// Limits and files of a run, which do not change the image.
struct RunDescription {
  std::optional<double> memory, textureMemory;  // bytes; nullopt: the machine's, and no limit
  std::optional<std::string> cache;             // file of the irradiance cache
  std::optional<std::string> checkpoint;
  double checkpointEvery = 300;      // seconds
  std::optional<double> writeEvery;  // seconds
  bool resumes = false;
  bool isOfFrames = false;  // others follow, of the same files
  bool isWatched = false;   // snapshots may be taken; a Session sets it
  bool makesImage = true;   // false: no image of the description's size is made, as in bakes
};

struct OutputDescription {
  std::vector<std::string> files;
  bool makesFolders = false;        // the scene file names the outputs
  std::vector<std::string> layers;  // as they were asked for
  std::optional<std::string> stats, noiseMap;
  DevelopSettings develop;       // of a .png, before `display`
  DisplayTransform display;      // of a .png
  bool choosesExposure = false;  // the display's is not known: meteredExposure()

  void expose(float stops) { display.exposure = stops, choosesExposure = false; }
};

struct RenderDescription : SceneParts {
  // From memory (scene/builder), in place of models or together with them; null: none.
  std::shared_ptr<const Scene> scene;
  CameraDescription camera;
  StandDescription stand;
  ProbeDescription probe;
  LightingDescription lighting;
  std::optional<CompositeDescription> composite;

  RenderSettings settings;  // of the integrator; its width and height are set by loadScene()
  std::optional<ImageSize>
      size;  // nullopt: the height of `settings`, as wide as the model's camera
  SingleSided singleSided = SingleSided::Camera;
  bool choosesSides = false;          // loadScene() may decide for SingleSided::Light
  bool straightGlassShadows = false;  // passShadowsStraight()

  OutputDescription output;
  RunDescription run;

  // The scene's name in messages: the first model's.
  bool hasPlate() const { return composite && composite->mode != CompositeMode::ShadowCatcher; }
  std::string sceneName() const { return models.empty() ? "the scene" : models.front().file; }
};

}  // namespace chromeball
