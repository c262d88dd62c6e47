// SPDX-License-Identifier: Apache-2.0
// A light stage under probes that turn, fast enough to follow a hand.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/tonemap.h"
#include "relight/stage/light_stage.h"

namespace chromeball {

struct NamedProbe {
  std::string name;
  Image map;  // lat-long
};

class RelightView {
 public:
  // Maps wider than 512 texels are reduced to that.
  RelightView(LightStage stage, std::vector<NamedProbe> probes);

  const LightStage& stage() const { return stage_; }
  const std::vector<NamedProbe>& probes() const { return probes_; }

  // The pixels for a screen, four bytes each: R, G, B, 255. Thread-safe.
  std::vector<uint8_t> picture(size_t probe, const Rotation& rotation,
                               const DisplayTransform& display) const;

 private:
  LightStage stage_;
  std::vector<NamedProbe> probes_;
};

}  // namespace chromeball
