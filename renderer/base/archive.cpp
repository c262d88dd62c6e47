// SPDX-License-Identifier: Apache-2.0
#include "base/archive.h"

#include "base/error.h"

namespace chromeball {

void Archive::throwDamaged() const {
  throwInput("{}: damaged: its parts do not fit together", name());
}

}  // namespace chromeball
