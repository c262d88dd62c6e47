// SPDX-License-Identifier: Apache-2.0
// Paths that look for light of every direction at once.
#pragma once

#include "transport/path.h"

namespace chromeball {

// A probe whose light no path adds: where a path escapes, the caller decides what it finds.
class NoProbe : public LightSource {
 public:
  void sample(const LightPoint&, const PixelSampler&,
              std::vector<DirectionSample>&) const override {}
};

// A path adds throughput x (radiance from the direction) if the probe is open to it.
struct EscapingPath {
  bool escapes = false;
  Rgb throughput{0};
  vec3 direction{0};
  Rgb found{0};  // of the scene's own lamps and emission
};

// Follows a path up to where it ends. `tracer`: of a NoProbe.
inline EscapingPath follow(const PathTracer& tracer, PathState state, PathContext& context) {
  for (;;) {
    context.sampler.startVertex(state.depth);
    const std::optional<Hit> hit = tracer.nextHit(state, context);
    const bool goesOn = tracer.vertex(state, hit, context);
    if (!hit) return {true, state.throughput, state.ray.direction, state.radiance};
    if (!goesOn) return {false, Rgb(0), vec3(0), state.radiance};
  }
}

}  // namespace chromeball
