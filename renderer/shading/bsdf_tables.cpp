// SPDX-License-Identifier: Apache-2.0
#include "shading/bsdf_tables.h"

#include <algorithm>

namespace chromeball {
namespace {

// Textures scale the factors of a material by at most 1, so a factor of 0 stays 0.
bool needsEnergy(const Material& m) { return m.metallic > 0 || m.specular > 0 || m.extended; }
bool needsAnisotropic(const Material& m) { return m.extended && m.extended->anisotropy > 0; }
bool needsSheen(const Material& m) { return m.extended && !isBlack(m.extended->sheenColor); }
bool needsGlass(const Material& m) { return m.isBody() && m.roughness > 0; }
bool isBody(const Material& m) { return m.isBody(); }

}  // namespace

BsdfTables::BsdfTables(std::span<const Material> materials, bool widened) {
  if (std::ranges::any_of(materials, needsEnergy)) energy = std::make_shared<EnergyTable>();
  if (std::ranges::any_of(materials, needsAnisotropic))
    anisotropic = std::make_shared<AnisotropicTable>();
  if (std::ranges::any_of(materials, needsSheen)) sheen = std::make_shared<SheenTable>();
  if (std::ranges::any_of(materials, widened ? isBody : needsGlass))
    glass = std::make_shared<GlassTable>();
}

}  // namespace chromeball
