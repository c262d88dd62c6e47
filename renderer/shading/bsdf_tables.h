// SPDX-License-Identifier: Apache-2.0
// The precomputed tables of the BSDFs of a scene.
#pragma once

#include <optional>
#include <span>

#include "scene/material.h"
#include "shading/anisotropic_table.h"
#include "shading/energy_table.h"
#include "shading/glass_table.h"
#include "shading/sheen_table.h"

namespace chromeball {

// Builds only the tables that the materials need; none for Lambertian materials. Must outlive the
// BSDFs.
struct BsdfTables {
  explicit BsdfTables(std::span<const Material> materials);

  std::optional<EnergyTable> energy;
  std::optional<AnisotropicTable> anisotropic;
  std::optional<SheenTable> sheen;
  std::optional<GlassTable> glass;
};

}  // namespace chromeball
