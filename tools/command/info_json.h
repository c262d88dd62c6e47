// SPDX-License-Identifier: Apache-2.0
// What `chromeball info` knows about a model.
#pragma once

#include "json_values.h"
#include "scene/gltf/model_info.h"

namespace chromeball {

JsonValue modelToJson(const ModelInfo& info, const std::string& file);

uint64_t byteCountOf(const std::vector<std::string>& files);
const char* lightKind(const PunctualLight& light);  // "directional", "point" or "spot"

}  // namespace chromeball
