// SPDX-License-Identifier: Apache-2.0
// BSDF tables for all kinds of materials, built once for all tests.
#pragma once

#include "shading/bsdf_tables.h"

namespace chromeball {

inline const BsdfTables& allTables() {
  static const BsdfTables tables = [] {
    Material material;
    material.extended.emplace();
    material.extended->transmission = 1;
    material.extended->thinWalled = false;
    material.extended->sheenColor = Rgb(1);
    material.extended->anisotropy = 1;
    return BsdfTables(std::span(&material, 1));
  }();
  return tables;
}

}  // namespace chromeball
