// SPDX-License-Identifier: Apache-2.0
// What the camera sees behind mirrors, glass and other narrow lobes (FirstHit::seen).
#pragma once

#include "lighting/light_source.h"
#include "scene/surface.h"
#include "transport/world.h"

namespace chromeball {

struct PathState;

class SeenFeature {
 public:
  SeenFeature(const World& world, const LightSource& lighting);

  // These set state.first->seen, which must exist, if all lobes of the path were narrow.
  // `escaped`: the radiance that the path has found in the background.
  void noteEscaped(const PathState& state, const Rgb& escaped) const;
  static void noteSurface(const PathState& state, const MaterialPoint& material);

 private:
  float median_;  // luminance of the background; 1 if it is black
};

}  // namespace chromeball
