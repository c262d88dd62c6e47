// SPDX-License-Identifier: Apache-2.0
// How much memory a picture takes, known before any is taken.
#pragma once

#include "integrate/render.h"

namespace chromeball {

// The most that film, layers and what is written from them take at one time, in bytes.
double pictureBytes(const RenderSettings& settings);

// What a picture may take unless the user says otherwise: 0.8 times the machine's memory, or the
// process's limit where that is less.
double memoryBudget();

}  // namespace chromeball
