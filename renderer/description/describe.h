// SPDX-License-Identifier: Apache-2.0
// A description as text: for the headers of images and the identity of stored renders.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
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

}  // namespace chromeball
