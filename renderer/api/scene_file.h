// SPDX-License-Identifier: Apache-2.0
// Descriptions from scene files and models:
//
//   RenderDescription description = planRender(openScene("scene.toml"));
#pragma once

#include "front/plan_render.h"
#include "front/scene_file.h"
