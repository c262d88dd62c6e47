// SPDX-License-Identifier: Apache-2.0
// A description as text: for the headers of images and the identity of stored renders.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include "description/render_description.h"

namespace chromeball {

// Every value that determines the pixels, under the names of the options of `chromeball render`, in
// their syntax: given to it, they reproduce the image. Also `noise-limit` and `time-limit`
// (percent, seconds); and hashes of the parts that are no options, if there are any: models,
// scene-camera, lens, optics, scene-lights, sources, surroundings, local-scene, composite.
nlohmann::ordered_json describe(const RenderDescription& description);

// The names of the layers, of plain renders and composites.
std::vector<std::string> layerNames(const RenderDescription& description);

}  // namespace chromeball
