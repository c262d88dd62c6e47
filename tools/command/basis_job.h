// SPDX-License-Identifier: Apache-2.0
// The job of `chromeball basis`: a scene whose light comes from everywhere.
#pragma once

#include "front/plan_render.h"
#include "scene_options.h"
#include "session/run_job.h"

namespace chromeball {

// The job without the scene's probe, which relighting replaces. `command`: for pixels or vertices.
// Throws InputError for composites and surroundings, which cannot be relit.
RenderDescription basisJob(const SceneOptions& options, SceneCommand command);

LoadedScene loadBasisScene(const RenderDescription& job);

}  // namespace chromeball
