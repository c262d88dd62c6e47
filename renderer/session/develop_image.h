// SPDX-License-Identifier: Apache-2.0
// Develops the image of a render or of a file (image/develop/develop.h).
#pragma once

#include "base/message.h"
#include "description/render_description.h"
#include "image/develop/develop.h"
#include "image/io/write_image.h"
#include "session/render_loaded.h"

#include <atomic>

namespace chromeball {

// The place of an image with this metadata in the view of its camera: `cameraFov` is the vertical
// field of view in degrees, 0 for an orthographic camera.
ViewFrame viewFrame(const Image& image, const std::optional<Placement>& placement,
                    const Metadata& metadata);

// Warnings of invalid pixels and of discs that were made smaller.
Messages inWords(const DevelopReport& report);

// Writes the outputs of a description: .png developed as description.output.develop says, others as
// rendered. Returns warnings; steps that the image lacks data for (a field of view, depth) are
// skipped with a warning. Throws as writeImage() does.
Messages writeOutputs(const RenderDescription& description, const OutputImage& image);

// The exposure of a render's .png, where it is left to the picture.

// Whether an exposure is to be chosen, and something needs it: a .png, or the merge of a part.
bool needsExposure(const RenderDescription& description);

// autoExposure() (image/tonemap.h) of a small render of the whole picture, so that the parts
// of a render find the same. 0 if `stop` is set meanwhile.
float meteredExposure(const LoadedScene& loaded, const PreparedScene& prepared,
                      const std::atomic<bool>& stop);

// "exposure +1.3 stops (auto)"
std::string chosenInWords(float exposure);

}  // namespace chromeball
