// SPDX-License-Identifier: Apache-2.0
// A scene with its acceleration structure and light tables.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "lighting/scene_sources.h"
#include "scene/scene.h"
#include "shading/bsdf_tables.h"
#include "trace/accel.h"
#include "trace/coincidence.h"
#include "transport/plain_surfaces.h"

namespace chromeball {

// Data that all renders of a scene share, independent of the lighting strategy: the acceleration
// structure, and tables for the kinds of light and material that occur in the scene.
struct World {
  // `masks`: by instance, for rays that see part of the scene (trace/ray.h); empty: all rays see
  // all instances. `described` must outlive this. Throws RunError.
  explicit World(const Scene& described, const std::vector<RayMask>& masks = {})
      : World(described, masks, BsdfTables(described.materials)) {}
  // Copies the BSDF tables of another world, which must include those that the materials need.
  // `earlier`: as for Accel.
  World(const Scene& described, const std::vector<RayMask>& masks, const BsdfTables& tables,
        std::shared_ptr<BuiltGeometry> earlier = nullptr)
      : scene(described),
        accel(described, masks, std::move(earlier)),
        sources(described),
        sharedPlaces(accel),
        loneTriangles(accel),
        bsdfTables(tables),
        plain(described),
        hasBodies(std::ranges::any_of(described.materials, &Material::isBody)) {}

  const Scene& scene;
  const Accel accel;
  const SceneSources sources;
  const SharedPlaces sharedPlaces;
  const LoneTriangles loneTriangles;
  const BsdfTables bsdfTables;  // the tables that its materials need
  const PlainSurfaces plain;
  const bool hasBodies;  // of glass
};

}  // namespace chromeball
