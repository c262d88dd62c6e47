// SPDX-License-Identifier: Apache-2.0
// What is said about a rendered image.
#pragma once

#include <optional>
#include <string>

#include "base/message.h"
#include "render/render.h"
#include "session/load_scene.h"
#include "session/render_loaded.h"
#include "trace/accel.h"

namespace chromeball {

// The messages of `result`, and messages about excluded samples, clamped light, light beyond the
// depth limits, and images that are nearly black or mostly clipped.
Messages resultMessages(const LoadedScene& loaded, const PreparedScene& prepared,
                        const FinishedRender& result, const SettingWords& words);

// A limit of depth: "--max-depth 8", "--integrator direct".
std::string limitInWords(DepthLimit limit, const RenderSettings& settings,
                         const SettingWords& words);

// Only the messages about excluded samples and clamped light.
void addExcluded(const RenderResult& result, const SettingWords& words, Messages& messages);

// The likely cause, with the setting to try, if no surface is in view or nearly all that are have
// remained black; nullopt otherwise. Limits and parts of the light that took what there was are
// named first.
std::optional<std::string> whyBlack(const LoadedScene& loaded, const Accel& accel,
                                    const RenderResult& result, const SettingWords& words);

}  // namespace chromeball
