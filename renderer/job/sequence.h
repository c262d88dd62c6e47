// SPDX-License-Identifier: Apache-2.0
// The frames of an animation.
#pragma once

#include <vector>

#include "job/scene_file.h"

namespace chromeball {

// A frame is a still, with settings that say when it is and where the camera has turned to.
struct SequenceFrame {
  int number;
  SceneFile scene;  // with the frame's number in the names of output files
  Settings given;   // over the scene's, as for planJob()
};

// The frames that `--frames` names, or that of them which `--frame` names; none if neither is
// given. SequenceFrame k is at k / fps seconds. The camera turns by (k - first) / (last + step -
// first) of `orbit`, so that a last turn of the same size would close a circle. Throws InputError.
std::vector<SequenceFrame> framesOf(const SceneFile& scene, const Settings& given);

// Replaces the last row of # by the number, with at least as many digits.
std::string withNumber(const std::string& pattern, int number);

}  // namespace chromeball
