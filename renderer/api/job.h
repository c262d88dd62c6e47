// SPDX-License-Identifier: Apache-2.0
// Everything a program needs to render a scene file:
//
//   RenderDescription job = planJob(openScene("scene.toml"));
//   LoadedScene loaded = loadScene(job);
//   JobResult result = renderJob(loaded);
//   const Image& image = result.color();   // linear RGB, row 0 at the top
//
// All of these throw InputError or RunError (base/error.h); none prints or writes anything.
#pragma once

#include "base/error.h"
#include "front/plan_render.h"
#include "front/scene_file.h"
#include "session/load_scene.h"
#include "session/run_job.h"
