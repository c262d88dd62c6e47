// SPDX-License-Identifier: Apache-2.0
// What a user should know of a picture on which little is to be seen.
#pragma once

#include <optional>
#include <string>

#include "integrate/render.h"
#include "job/load_scene.h"

namespace chromeball {

// Where nearly every surface that the camera sees is black, or most are and single-sided: a line
// that says the likely cause.
std::optional<std::string> whyBlack(const LoadedScene& loaded, const Accel& accel,
                                    const RenderResult& result);

// Where most of a tone mapped picture is clipped: a line that says what would show it.
std::optional<std::string> whyWhite(const RenderJob& job, const LoadedScene& loaded,
                                    const RenderResult& result);

}  // namespace chromeball
