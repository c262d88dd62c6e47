// SPDX-License-Identifier: Apache-2.0
// The Embree that runs, which has code for several instruction sets and chooses one.
#pragma once

#include <string>

namespace chromeball {

struct EmbreeVersion {
  std::string version;  // "3.13.5"
  int lanes;            // rays that it traces at once: 4 with SSE, 8 with AVX, 16 with AVX-512
};
EmbreeVersion embreeVersion();

}  // namespace chromeball
