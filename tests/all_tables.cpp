// SPDX-License-Identifier: Apache-2.0
#include "all_tables.h"

namespace chromeball {

const BsdfTables& allTables() {
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
