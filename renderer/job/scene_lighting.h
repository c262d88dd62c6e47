// SPDX-License-Identifier: Apache-2.0
// The light of a job: its probe, and the strategy that samples it.
#pragma once

#include "job/load_scene.h"

namespace chromeball {

// Throws InputError if nothing lights a scene that has no probe.
void checkLit(const RenderJob& job, const Scene& scene);

// The probe's map: the job's file, else the model's own environment, which it takes, else black if
// the scene has lights of its own. Throws InputError.
LoadedProbe loadProbeOf(const RenderJob& job, Scene& scene);

// With the job's rotation and scale; frees the map.
Probe probeOf(const RenderJob& job, LoadedProbe& loaded);

// The strategy, with the probe mapped onto the scene's surroundings and with the scene file's suns,
// if it has any. `loaded` must outlive it. Throws InputError for an unknown name.
std::unique_ptr<LightingStrategy> makeLighting(const NamedSetting& strategy, Mis mis,
                                               const LoadedScene& loaded);

}  // namespace chromeball
