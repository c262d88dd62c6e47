// SPDX-License-Identifier: Apache-2.0
// The table of lighting methods: methods that sample a probe, and methods that replace it by
// directional lights.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/image.h"
#include "lighting/constellation/directional_light.h"
#include "lighting/strategy.h"

namespace chromeball {

struct CountRange {
  int min = 0, max = 0;  // both 0: no count
  int usual = 0;         // the default of a strategy
};

// Options of makeLights().
struct LightRequest {
  std::optional<int> count;  // of lights; for cube-grid, of squares along a face's edge
  uint64_t seed = 0;         // for stochastic methods
  // For the fits: also fit a constant radiance from all directions; use the smallest number of
  // lights (at most `count`) whose mean error in percent does not exceed maxErrorPercent.
  bool ambient = false;
  std::optional<double> maxErrorPercent;
  std::optional<int> levels;  // for median cut, in place of the count: at most 2^levels regions
};

struct MadeLights {
  Constellation lights;
  std::optional<Rgb> ambient;       // radiance from all directions, where it was fitted
  std::optional<double> meanError;  // of a fit, in percent (fit/light_descent.h)
};

struct LightingMethod {
  std::string_view name;     // as on the command line
  std::string_view summary;  // one line, for help
  std::string_view source;   // author and year, or section; empty: none

  // The method as a strategy for rendering: NAME, or NAME:COUNT.
  CountRange counts;
  std::function<std::unique_ptr<LightSource>(const Probe&, const StrategyOptions&, int count)>
      makeStrategy;
  bool isUnbiased = false;
  bool replacesProbe = false;  // by lights, which the camera can see (StrategyOptions::showLights)

  // The method as directional lights that replace a lat-long map.
  struct Lights {
    std::function<MadeLights(const Image& latLong, const LightRequest&)> make;  // empty: none
    CountRange counts;
    bool countIsOptional = false;
    bool isStochastic = false;  // the seed changes the lights
    bool fitsAmbient = false, takesMaxError = false, takesLevels = false;
    // The irradiances sum to the map's radiance x solid angle, channel by channel.
    bool keepsEnergy = false;
    // The regions that the same request's lights stand for; empty: the method has none.
    std::function<LightRegions(const Image& latLong, const LightRequest&)> regions;
  } lights;
};

const std::vector<LightingMethod>& lightingMethods();

// The method that makes lights, by name. Throws InputError, which starts with `location`.
const LightingMethod& lightMethod(std::string_view name, std::string_view location);

// The lights that replace `latLong` (at least three channels). Directions are unit; the result is
// deterministic. Methods that keep energy make no black or negative lights. Their number is
// min(count, number of lit cells), where a cell is a texel, or a block of texels of a large map; a
// black map gives none; `levels` gives at most 2^levels. Exceptions: cube-grid makes up to 6
// count^2 lights, one for each lit square; penrose makes `count` lights unless the map is black;
// suns makes one for each sun that it finds, at most `count`. Throws InputError for an unknown
// method, a count that is missing or out of range, or a texel that is negative or not finite.
MadeLights makeLights(std::string_view method, const Image& latLong, const LightRequest& request);

// Throws InputError for an unknown method, or a count that is missing or out of range.
void checkLightCount(std::string_view method, const LightRequest& request);

// Text for --help: one line for each strategy, or for each method that makes lights.
std::string strategyHelp();
std::string lightMethodHelp();

// The strategies as a table in Markdown, for documentation.
std::string strategyTable();

// The constellation methods (lighting/constellation/) as parts of rows of that table.

// Cut by energy if a count is given, by levels if a number of levels is given.
LightingMethod::Lights medianCutLights(CountRange counts);

// Cut by levels: lights at the regions' centres; and a cut of the map as a flat picture.
LightingMethod::Lights centreCutLights(CountRange counts);
LightingMethod::Lights flatCutLights(CountRange counts);

LightingMethod::Lights varianceCutLights(CountRange counts);
LightingMethod::Lights lightGenLights(CountRange counts);
LightingMethod::Lights kolligKellerLights(CountRange counts);
LightingMethod::Lights strataLights(CountRange counts);
LightingMethod::Lights cubeGridLights(CountRange counts);
LightingMethod::Lights penroseLights(CountRange counts);

}  // namespace chromeball
