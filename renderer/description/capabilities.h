// SPDX-License-Identifier: Apache-2.0
// What cannot be combined: one table, from which checks, messages and documentation are made.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "description/render_description.h"

namespace chromeball {

// A property of a description that another one may exclude.
struct Feature {
  std::string_view name;     // "a composite", for documentation
  std::string_view setting;  // whose origin messages name, and that may end a conflict; empty: none
  bool (*isIn)(const RenderDescription&);
};

struct Conflict {
  const Feature& feature;  // at whose setting the message begins
  const Feature& with;
  std::string_view why;  // and what to do
};

std::span<const Conflict> conflicts();

// The first one in a description; null: none.
const Conflict* conflictIn(const RenderDescription& description);

// Throws InputError "SETTING'S ORIGIN: WHY" for the first one.
void checkCapabilities(const RenderDescription& description);

}  // namespace chromeball
