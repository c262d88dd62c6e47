// SPDX-License-Identifier: Apache-2.0
// Explains why a rendered image shows nothing.
#pragma once

#include <optional>
#include <string>

#include "render/render.h"
#include "session/load_scene.h"
#include "trace/accel.h"

namespace chromeball {

// The likely cause, with the option to try, if no surface is in view or nearly all that are have
// remained black; nullopt otherwise. Limits and parts of the light that took what there was are
// named first.
std::optional<std::string> whyBlack(const LoadedScene& loaded, const Accel& accel,
                                    const RenderResult& result);

}  // namespace chromeball
