// SPDX-License-Identifier: Apache-2.0
// Where the models stand: dropped to the ground, turned on a turntable, with a plane below.
#pragma once

#include <vector>

#include "session/place_models.h"

namespace chromeball {

// Whether AutomaticView::lowest or its axis are needed.
bool needsStand(const RenderDescription& description);

// Where the models' lowest point shall be; nullopt: they are not dropped.
std::optional<double> floorOf(const RenderDescription& description);

// How far the models move up, metres, if their lowest point is at this height (y in the world).
double dropOf(const RenderDescription& description, double lowest);

// The models with the placements that make them stand as described.
std::vector<ModelEntry> standing(const RenderDescription& description,
                                 std::vector<ModelEntry> models, const AutomaticView& view);

// Turns the models' cameras back, which stand still; `origin`: of the scene's coordinates.
void turnBackCameras(const RenderDescription& description, const AutomaticView& view,
                     const glm::dvec3& origin, Scene& scene);

// Adds the ground of a plain render to the scene; tells the composite of a shadow catcher that
// names it the height.
void addGround(RenderDescription& description, const AutomaticView& view, const glm::dvec3& origin,
               Scene& scene);

}  // namespace chromeball
