// SPDX-License-Identifier: Apache-2.0
// What of a render must be made again when its description changes.
#pragma once

#include <set>
#include <string>

#include "description/render_description.h"

namespace chromeball {

// What is in memory differs if it is another object: hashes of a large scene would take as long as
// a frame.
class Differences {
 public:
  Differences(const RenderDescription& a, const RenderDescription& b);

  // Nothing of the models and of what else is in the scene; a name that is in none of the lists of
  // differences.cpp loads everything again.
  bool keepScene() const;
  static bool keepsScene(const std::string& name);
  bool inProbe() const;
  bool inLighting() const;  // the way of sampling the light

 private:
  std::set<std::string> names_;  // of describe()
};

}  // namespace chromeball
