// SPDX-License-Identifier: Apache-2.0
// The part of a time limit that is kept for what follows the samples.
#pragma once

#include <optional>

#include "description/render_description.h"

namespace chromeball {

// The settings with the time limit of the samples alone. From the limit is taken what denoising
// takes, by the time of a small image, and writing the description's files; at most three quarters
// of it. Without a limit, or a file to write, the settings as they are.
struct KeptTime {
  RenderSettings settings;
  double seconds = 0;
};
KeptTime keepTime(const RenderDescription& description);

}  // namespace chromeball
