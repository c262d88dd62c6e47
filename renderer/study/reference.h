// SPDX-License-Identifier: Apache-2.0
// The reference image of a study.
#pragma once

#include "base/message.h"
#include "measure/bias_variance.h"
#include "study/render_store.h"

namespace chromeball {

// Reads the reference from its file, or takes the mean of its parts from the store, which must have
// all of them. Throws InputError if the file has no colour or is not of the given size.
Reference loadReference(const Study& study, const RenderStore& store, int width, int height,
                        Messages* messages = nullptr);

}  // namespace chromeball
