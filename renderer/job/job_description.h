// SPDX-License-Identifier: Apache-2.0
// What makes a picture, in one table: its header, its statistics and the identity of a stored
// render all say it by this.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/io/read_image.h"
#include "job/load_scene.h"

namespace chromeball {

// Every setting that decides the pixels, as command line, scene file and defaults resolved it,
// under the name of the option that sets it: given to `render SCENE` as they stand here, they make
// the picture again. What is no option follows:
//   files                     all that were read: models, their buffers and images, probe, plate
//   probe-found               the mapping that `probe-mapping` came to
//   noise-limit, time-limit   where they ended the samples (percent, seconds)
//   cameraPosition (metres), cameraFov (vertical, degrees; 0: orthographic), lensRadius, focus
//   worldToCamera, worldToNDC as OpenEXR and RenderMan define them: for row vectors; camera space
//   is
//                             left-handed and looks along +Z; NDC is (0, 0) at the top left corner
//                             and (1, 1) at the bottom right
// An option that has no row of its own stands as it was given, so that a new one cannot be missing.
// The samples are left out: a limit may decide them, and then it makes the picture again, not their
// number, since the passes differ. `job` and `loaded`: as loadScene left them.
nlohmann::ordered_json describeJob(const RenderOptions& options, const RenderJob& job,
                                   const LoadedScene& loaded);

// The same as attributes of an EXR file: matrices as such, other lists as JSON.
Metadata toMetadata(const nlohmann::ordered_json& description);

// What all renders of a comparison have in common, as JSON: the description, less what a comparison
// varies by itself, the contents of all files, and the threads, on which seconds depend.
std::string identityOf(const RenderOptions& options, const RenderJob& job,
                       const LoadedScene& loaded);

// Why the renders of one identity are not those of another: "`mis` was off and is power".
std::string differenceOf(const std::string& stored, const std::string& own);

}  // namespace chromeball
