// SPDX-License-Identifier: Apache-2.0
// The parts of a render that must be made again when its description changes.
#pragma once

#include <set>
#include <string>

#include "description/render_description.h"

namespace chromeball {

// Data in memory count as different if they are another object: hashes of a large scene would take
// as long as a frame.
class Differences {
 public:
  Differences(const RenderDescription& a, const RenderDescription& b);

  // Whether nothing of the models and of the rest of the scene differs. A name that is in none of
  // the lists of differences.cpp loads everything again.
  bool keepScene() const;
  static bool keepsScene(const std::string& name);
  bool inProbe() const;
  bool inLighting() const;  // the way of sampling the light

 private:
  std::set<std::string> names_;  // of describe()
};

}  // namespace chromeball
