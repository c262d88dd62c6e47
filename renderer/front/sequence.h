// SPDX-License-Identifier: Apache-2.0
// The frames of an animation.
#pragma once

#include <vector>

#include "base/message.h"
#include "front/scene_file.h"

namespace chromeball {

// A frame is a still, with settings for its time and for the turn of the camera.
struct SequenceFrame {
  int number;
  SceneFile scene;  // with the frame's number in the names of output files
  Settings given;   // over the scene's, as for planRender()
};

// The frames that `--frames` names, or the one of them that `--frame` names. Frame k is at k / fps
// seconds. The camera turns by (k - first) / (last + step - first) of `orbit`, and the models of
// `turntable`, so that a last turn of the same size would close a circle.
class Sequence {
 public:
  // Throws InputError.
  Sequence(const SceneFile& scene, const Settings& given);

  const std::vector<int>& numbers() const { return numbers_; }  // empty: a still
  int first() const { return first_; }                          // of those that --frames names
  SequenceFrame frame(int number) const;                        // throws InputError
  // About keys of the scene file without effect on frames, or what a still has of a sequence.
  Messages messages() const;

 private:
  const SceneFile& scene_;
  const Settings& given_;
  Settings all_;
  int first_ = 0, end_ = 1;  // the end: the frame after the last
  std::vector<int> numbers_;
};

// Replaces the last row of # by the number, with at least as many digits.
std::string withNumber(const std::string& pattern, int number);

}  // namespace chromeball
