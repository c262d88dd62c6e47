// SPDX-License-Identifier: Apache-2.0
// A description as text: for the headers of images and the identity of stored renders, and to tell
// what two descriptions differ in.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "description/render_description.h"
#include "scene/scene.h"

namespace chromeball {

// Every value that determines the pixels, under the names of the options of `chromeball render`, in
// their syntax: given to it, they reproduce the image. Also `noise-limit` and `time-limit`
// (percent, seconds); and hashes of the parts that are no options, if there are any: models,
// scene-camera, lens, optics, scene-lights, sources, surroundings, local-scene, composite.
nlohmann::ordered_json describe(const RenderDescription& description);

// Adds the hashes to those values.
void addParts(const RenderDescription& description, nlohmann::ordered_json& to);

// The names of the layers, of plain renders and composites.
std::vector<std::string> layerNames(const RenderDescription& description);

// Tells a scene in memory from others.

// A hash of everything that rays and cameras see: geometry, materials, texels, lights, cameras.
// Takes one pass over the arrays.
uint64_t hashOf(const Scene& scene);

// The parts of a render that must be made again when its description changes.

// Data in memory count as different if they are another object: hashes of a large scene would take
// as long as a frame.
class Differences {
 public:
  Differences(const RenderDescription& a, const RenderDescription& b);

  // Whether nothing of the models and of the rest of the scene differs. A name that is in none of
  // the lists of differences.cpp loads everything again.
  bool keepScene() const;
  static bool keepsScene(const std::string& name);
  bool inProbe() const;
  bool inLighting() const;  // the way of sampling the light

 private:
  std::set<std::string> names_;  // of describe()
};

}  // namespace chromeball
