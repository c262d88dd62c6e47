// SPDX-License-Identifier: Apache-2.0
// Settings that cannot be combined, and settings that have no effect alone: two tables, from which
// checks, messages and documentation are made.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "description/render_description.h"

namespace chromeball {

// A property of a description that another one may exclude.
struct Feature {
  std::string_view name;     // "a composite", for documentation
  std::string_view setting;  // messages name its origin, and it may end a conflict; empty: none
  bool (*isIn)(const RenderDescription&);
};

struct Conflict {
  const Feature& feature;  // the message begins with its setting
  const Feature& with;
  std::string_view why;  // and what to do
};

std::span<const Conflict> conflicts();

// The first conflict in a description; null: none.
const Conflict* conflictIn(const RenderDescription& description);

// Throws InputError "SETTING: should be ..." for the first number out of its range. (Those of text
// have been checked where it was read.)
void checkNumbers(const RenderDescription& description);

// Throws InputError "SETTING'S ORIGIN: WHY" for the first conflict.
void checkCapabilities(const RenderDescription& description);

// What a description's files contain, as far as settings depend on it.
struct SceneContents {
  bool hasProbe = false;         // also from memory, or the models' own environment
  bool hasModelLights = false;   // punctual lights of the models
  bool hasSuns = false;          // extracted from the probe, or of the description
  bool hasProbeSuns = false;     // only asked for if their angle is given
  bool hasAmbientLight = false;  // lamps that light from everywhere
  bool hasAreaLights = false;    // suns, sources in the probe, emitting surfaces
  bool hasBodies = false, hasStraightGlass = false;  // of glass; with straight shadows
  bool hidesBacks = false;                           // of single-sided surfaces, unless told not to
  bool moves = false;                                // while the shutter is open
};

// A setting that has an effect only where there is something else.
struct Dependence {
  std::string_view setting;  // its name in the table of settings
  std::string_view needs;    // "a probe"
  bool (*isMet)(const RenderDescription&, const SceneContents&);
};

std::span<const Dependence> dependences();

// The origin of a given setting, with its name: "--shutter", "FILE:LINE: `camera.shutter`".
std::string namedOrigin(const RenderDescription& description, std::string_view setting);

// "--probe-rotation has no effect without a probe", or "FILE:LINE: `probe.rotation` ...", for each
// setting that was given and has no effect.
std::vector<std::string> idleSettings(const RenderDescription& description,
                                      const SceneContents& contents);

}  // namespace chromeball
