// SPDX-License-Identifier: Apache-2.0
// chromeball basis: a scene whose light comes from everywhere.
#pragma once

#include <optional>
#include <string>

#include "front/plan_render.h"
#include "scene_options.h"
#include "session/render_loaded.h"

namespace chromeball {

struct BasisArguments : SceneOptions {
  std::string at = "pixels", out;
  std::string directions, functions;  // at pixels; at vertices
  bool halves = false, isGlossy = false;
  std::optional<uint64_t> clusters, vectors;
};

// The description without the scene's probe, which relighting replaces. `command`: for pixels or
// vertices. Throws InputError for composites and surroundings, which cannot be relit.
RenderDescription basisJob(const SceneOptions& options, SceneCommand command);

LoadedScene loadBasisScene(const RenderDescription& description);

// These throw InputError and RunError. At pixels, bands of rows are rendered and written, as few as
// the memory allows.
void runBasisPixels(const BasisArguments& a);
void runBasisVertices(const BasisArguments& a);

}  // namespace chromeball
