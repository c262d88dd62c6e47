// SPDX-License-Identifier: Apache-2.0
// The exposure of a render's .png, where it is left to the picture.
#pragma once

#include <atomic>

#include "session/render_loaded.h"

namespace chromeball {

// Whether an exposure is to be chosen, and something needs it: a .png, or the merge of a part.
bool needsExposure(const RenderDescription& description);

// autoExposure() (image/auto_exposure.h) of a small render of the whole picture, so that the parts
// of a render find the same. 0 if `stop` is set meanwhile.
float meteredExposure(const LoadedScene& loaded, const PreparedScene& prepared,
                      const std::atomic<bool>& stop);

// "exposure +1.3 stops (auto)"
std::string chosenInWords(float exposure);

}  // namespace chromeball
