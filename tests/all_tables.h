// SPDX-License-Identifier: Apache-2.0
// BSDF tables for all kinds of materials, built once for all tests.
#pragma once

#include "shading/bsdf_tables.h"

namespace chromeball {

const BsdfTables& allTables();

}  // namespace chromeball
