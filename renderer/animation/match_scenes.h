// SPDX-License-Identifier: Apache-2.0
// The same parts and lamps in scenes of the same models at several times.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace chromeball {

// By instance of `scene`, the same part in `other`; null if the node has other parts there, or ones
// that are turned inside out.
std::vector<const Instance*> partsIn(const Scene& other, const Scene& scene);

// By lamp of `scene`, that of the same node in `other`; null if there is none.
std::vector<const PunctualLight*> lampsIn(const Scene& other, const Scene& scene);

}  // namespace chromeball
