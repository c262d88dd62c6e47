// SPDX-License-Identifier: Apache-2.0
// From a scene at several times to its motion.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace chromeball {

// Gives the instances and lamps of `scene`, which is at the opening of the shutter, the places and
// shapes that they have in `later`, at equally spaced times up to its closing. What one of `later`
// lacks stays there as it was before. Returns the names of the nodes with parts or lamps that
// `scene` or one of `later` lacks.
std::vector<std::string> addMotion(Scene& scene, const std::vector<Scene>& later);

// The same parts and lamps in scenes of the same models at several times.

// By instance of `scene`, the same part in `other`; null if the node has other parts there, or ones
// that are turned inside out.
std::vector<const Instance*> partsIn(const Scene& other, const Scene& scene);

// By lamp of `scene`, that of the same node in `other`; null if there is none.
std::vector<const PunctualLight*> lampsIn(const Scene& other, const Scene& scene);

}  // namespace chromeball
