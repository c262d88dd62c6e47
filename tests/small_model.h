// SPDX-License-Identifier: Apache-2.0
// Writes a model file of one triangle.
#pragma once

#include <string>

void writeSmallModel(const std::string& path);
