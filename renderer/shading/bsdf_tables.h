// SPDX-License-Identifier: Apache-2.0
// The tables that the BSDFs of a scene look up.
#pragma once

#include <optional>
#include <span>

#include "scene/material.h"
#include "shading/anisotropic_table.h"
#include "shading/energy_table.h"
#include "shading/glass_table.h"
#include "shading/sheen_table.h"

namespace chromeball {

// Holds those tables that the materials need, and no others: none for Lambertian materials. Belongs
// to whoever renders the scene, and must outlive the BSDFs.
struct BsdfTables {
  explicit BsdfTables(std::span<const Material> materials);

  std::optional<EnergyTable> energy;
  std::optional<AnisotropicTable> anisotropic;
  std::optional<SheenTable> sheen;
  std::optional<GlassTable> glass;
};

}  // namespace chromeball
