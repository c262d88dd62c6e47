// SPDX-License-Identifier: Apache-2.0
// Light where nothing covers the background, such as a caustic on a shadow catcher: associated
// colour above alpha. A .png has unassociated colour, at most 1, so it holds no more than alpha.
#pragma once

#include <filesystem>
#include <optional>

#include "base/message.h"
#include "image/image.h"

namespace chromeball {

// A warning if writing the image (RGBA) to `path`, a .png, loses such light. Only where alpha is
// below one half: the rest is clipped as any bright surface is.
std::optional<Message> uncoveredLightWarning(const std::filesystem::path& path, const Image& color);

}  // namespace chromeball
