// SPDX-License-Identifier: Apache-2.0
// The description of `chromeball basis`: a scene whose light comes from everywhere.
#pragma once

#include "front/plan_render.h"
#include "scene_options.h"
#include "session/render_loaded.h"

namespace chromeball {

// The description without the scene's probe, which relighting replaces. `command`: for pixels or
// vertices. Throws InputError for composites and surroundings, which cannot be relit.
RenderDescription basisJob(const SceneOptions& options, SceneCommand command);

LoadedScene loadBasisScene(const RenderDescription& description);

}  // namespace chromeball
