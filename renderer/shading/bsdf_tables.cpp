// SPDX-License-Identifier: Apache-2.0
#include "shading/bsdf_tables.h"

#include <algorithm>
#include <type_traits>

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
  complete(materials, widened);
}

void BsdfTables::complete(std::span<const Material> materials, bool widened) {
  const auto make = [&](auto& table, bool (*needs)(const Material&)) {
    using Table = typename std::remove_reference_t<decltype(table)>::element_type;
    if (!table && std::ranges::any_of(materials, needs)) table = std::make_shared<Table>();
  };
  make(energy, needsEnergy);
  make(anisotropic, needsAnisotropic);
  make(sheen, needsSheen);
  make(glass, widened ? isBody : needsGlass);
}

}  // namespace chromeball
