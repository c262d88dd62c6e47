// SPDX-License-Identifier: Apache-2.0
// The camera's settings of photographs, from their EXIF blocks or from the user.
#pragma once

#include <string>
#include <vector>

#include "probe/capture/exposure.h"

namespace chromeball {

// `times` (seconds) and `apertures` (f-numbers), one for each file, replace those of EXIF; either
// may be empty. If there are times, nothing is read from the files: no ISO either. Otherwise each
// file must state its time, and all of them or none the aperture and the ISO. Throws InputError.
std::vector<CameraSettings> cameraSettings(const std::vector<std::string>& files,
                                           const std::vector<double>& times,
                                           const std::vector<double>& apertures);

}  // namespace chromeball
