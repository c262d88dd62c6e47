// SPDX-License-Identifier: Apache-2.0
// What a program has changed in a job after planJob(): values that its settings do not tell.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "job/render_job.h"

namespace chromeball {

// The parts of a job that are no settings, as JSON: models, camera, lamps, sources, surroundings,
// and the composite with a hash of its plate (RenderJob::plannedParts).
std::string partsOf(const RenderJob& job);

// The names of the layers, of plain renders and composites.
std::vector<std::string> layerNames(const RenderJob& job);

// Sets what differs from the job as planJob() makes it: values of settings under the names of their
// options (job_description.h), and whole parts. Erases settings that the job no longer has.
void describeChanges(const RenderJob& job, nlohmann::ordered_json& description);

}  // namespace chromeball
