// SPDX-License-Identifier: Apache-2.0
// Surfaces that a path passes without a bounce.
#pragma once

#include "scene/extended_surface.h"
#include "trace/accel.h"
#include "transport/path.h"

namespace chromeball {

// Whether the path ignores the surface: the back of a single-sided surface, seen by the camera or
// in a mirror, or the back of a body that the path has not entered.
inline bool ignores(const PathState& state, const Material& material, bool frontFace) {
  return (state.isDelta && !frontFace && material.hidesBack()) ||
         state.media.ignores(material, frontFace);
}

// Whether the path may continue on the other side of the surface.
inline bool mayPass(const PathState& state, const Surface& surface) {
  const Material& m = *surface.material;
  return m.transmits() || (state.isDelta ? !surface.frontFace && m.hidesBack()
                                         : surface.frontFace && m.backLetsLightThrough());
}

// The front of a single-sided surface reflects light and also passes light that arrives at its
// back. A path that comes neither from the camera nor from a mirror follows one of the two at
// random, with twice the throughput; the MIS weights stay valid, because shadow rays pass the front
// too.
inline bool passesFromBehind(const PathState& state, const Material& material, bool frontFace) {
  return !state.isDelta && frontFace && material.backLetsLightThrough();
}
inline bool continuesBehind(const Hit& hit, const PixelSampler& sampler) {
  constexpr uint64_t kPurpose = 0x6f6e6577;  // separate random stream
  return hash(sampler.sampleKey() ^ kPurpose, uint64_t(hit.instance) << 32 | hit.triangle) & 1;
}

// Whether shadow rays from the path's last vertex pass the surface, so that the path passes it
// without refraction too.
inline bool goesStraight(const PathState& state, const Material& material) {
  return passesStraight(material) || (state.scattered && material.straightShadows);
}

// Continues the path straight through the surface. `state.from` and its pdf stay, because shadow
// rays from there pass the surface too.
inline void passStraight(PathState& state, const Surface& surface) {
  state.leave(surface, state.ray.direction);
  if (!surface.material->isBody()) ++state.straight;  // passing a body's surface is a transmission
}

// For a path without bounces left: continues straight through the surface, since light from behind
// it is direct light of the previous vertex. Returns false if nothing passes.
inline bool passAtLimit(const Scene& scene, PathState& state, const Instance& instance,
                        const Surface& surface) {
  if (!surface.material->extended) return false;
  state.throughput *= straightTransmittance(scene, instance, surface, state.ray.direction);
  if (isBlack(state.throughput)) return false;
  ++state.depth;
  passStraight(state, surface);
  return true;
}

}  // namespace chromeball
