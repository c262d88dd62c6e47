// SPDX-License-Identifier: Apache-2.0
// The precomputed tables of the BSDFs of a scene.
#pragma once

#include <memory>
#include <span>

#include "scene/material.h"
#include "shading/energy_table.h"
#include "shading/glass_table.h"
#include "shading/sheen_table.h"

namespace chromeball {

// Those tables that the materials need, and no others: none for Lambertian materials. Copies share
// the tables, each of which takes up to 0.3 s of one core. Must outlive the BSDFs.
struct BsdfTables {
  // `widened`: smooth materials may become rough (transport/regularization.h).
  explicit BsdfTables(std::span<const Material> materials, bool widened = false);
  // Makes those that are missing.
  void complete(std::span<const Material> materials, bool widened = false);

  std::shared_ptr<const EnergyTable> energy;
  std::shared_ptr<const AnisotropicTable> anisotropic;
  std::shared_ptr<const SheenTable> sheen;
  std::shared_ptr<const GlassTable> glass;
};

}  // namespace chromeball
