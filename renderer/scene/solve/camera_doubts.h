// SPDX-License-Identifier: Apache-2.0
// Signs that a camera was found from wrong observations.
#pragma once

#include "base/message.h"
#include "scene/bounds.h"
#include "scene/solve/observations.h"
#include "scene/solve/solved_camera.h"

namespace chromeball {

// Warnings about observations that no camera fits, that two cameras fit, or that leave the field of
// view uncertain.
Messages doubtsAbout(const CameraFit& fit);

// About points outside the picture.
Messages doubtsAbout(const std::vector<ObservedPoint>& points, const ImageSize& size);

// About a camera that does not see the model.
Messages doubtsAbout(const SolvedCamera& camera, const Bounds& model);

}  // namespace chromeball
