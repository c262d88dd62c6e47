// SPDX-License-Identifier: Apache-2.0
// The light of a description: its probe, and the strategy that samples it.
#pragma once

#include <algorithm>
#include <optional>

#include "approximate/environment_map.h"
#include "base/text.h"
#include "description/render_description.h"
#include "lighting/polygon_lights.h"
#include "lighting/strategy.h"
#include "probe/load.h"
#include "scene/scene.h"

namespace chromeball {

struct LoadedScene;

// Throws InputError if nothing lights a scene that has no probe.
void checkLit(const RenderDescription& description, const Scene& scene);

// Removes the lamps and emission that the description leaves out.
void removeLamps(const RenderDescription& description, Scene& scene);

// The probe's map, or the part of it that the description renders: from the description's file,
// else the model's own environment, which is moved out of `scene`, else black if the scene has
// lights of its own. Throws InputError.
LoadedProbe loadProbeOf(const RenderDescription& description, Scene& scene);

// The polygons of the probe that are sources of their own ([[source]]), and what is left of it.
struct ProbeSources {
  std::vector<PolygonLight> lights;
  Image hidden;  // PolygonLights
  Probe remainder;

  // Whether the camera sees a polygon in place of the probe's texels.
  bool areSeen() const {
    return std::ranges::any_of(lights, [](const PolygonLight& l) { return !l.isIllum; });
  }
};
// Nullopt if the description renders none. `loaded`: the file that `probe` is from. Throws
// InputError.
std::optional<ProbeSources> sourcesOf(const RenderDescription& description,
                                      const LoadedProbe& loaded, const Probe& probe);

// The probe with the description's rotation and scale; frees the map.
Probe probeOf(const RenderDescription& description, LoadedProbe& loaded);

// The probe with every channel multiplied by its factor.
Probe scaled(const Probe& probe, const Rgb& factor);

// W/m^2 on an unoccluded surface with this unit normal.
Rgb irradianceOn(const Probe& probe, const vec3& normal);

// The strategy, with the probe mapped onto the scene's surroundings. `splitsProbe`: for light
// groups, tells the probe's suns from the rest. `loaded` must outlive it. Throws InputError for an
// unknown name.
std::unique_ptr<LightSource> makeLighting(const NamedSetting& strategy, Mis mis,
                                          const LoadedScene& loaded, bool splitsProbe = false);
// The lighting of the description: made by its own function, else by the named strategy.
std::unique_ptr<LightSource> makeLighting(const LoadedScene& loaded);

// The probe as the integrator uses it, with its suns apart under the strategy `suns`; null if it
// does not.
std::unique_ptr<const EnvironmentLight> makeEnvironment(IntegratorKind integrator,
                                                        const std::string& strategy,
                                                        const LoadedScene& loaded);

}  // namespace chromeball
