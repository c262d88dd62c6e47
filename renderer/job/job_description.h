// SPDX-License-Identifier: Apache-2.0
// All settings that decide an image's pixels, in one table: for the EXR header, the statistics and
// the identity of a stored render.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/io/read_image.h"
#include "job/load_scene.h"

namespace chromeball {

// Every setting that decides the pixels, as resolved from command line, scene file and defaults,
// under the name of its option: given to `render SCENE`, they make the same image again. Also:
//   files                     all files read: models, their buffers and images, probe, plate
//   probe-found               the mapping that `probe-mapping` resolved to
//   noise-limit, time-limit   the limits of the samples (percent, seconds)
//   cameraPosition (metres), cameraFov (vertical, degrees; 0: orthographic), lensRadius, focus
//   worldToCamera, worldToNDC as OpenEXR and RenderMan define them: for row vectors; camera space
//                             is left-handed and looks along +Z; NDC is (0, 0) at the top left
//                             corner and (1, 1) at the bottom right
// The number of samples is missing: if a limit decided it, the limit makes the same image again,
// and the number would not, since the passes differ. `job` and `loaded`: as loadScene left them.
nlohmann::ordered_json describeJob(const RenderJob& job, const LoadedScene& loaded);

// The same as attributes of an EXR file: matrices as such, other lists as JSON.
Metadata toMetadata(const nlohmann::ordered_json& description);

// What all renders of a comparison have in common, as JSON: the description without what the
// comparison varies, the contents of all files, and the number of threads, on which seconds depend.
std::string identityOf(const RenderJob& job, const LoadedScene& loaded);

// The first difference between two identities: "`mis` was off and is power".
std::string differenceOf(const std::string& stored, const std::string& own);

}  // namespace chromeball
