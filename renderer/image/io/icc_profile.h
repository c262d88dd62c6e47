// SPDX-License-Identifier: Apache-2.0
// ICC profiles (ISO 15076-1) of an image of light. They are not applied, but compared with what the
// texels are read as.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "image/chromaticities.h"

namespace chromeball {

// A profile of a curve for each channel, of RGB also of primaries (8.3.3, 8.4.2 there). One that is
// damaged, or of another kind, such as tables of colours, agrees with nothing.
class IccProfile {
 public:
  // `bytes` must outlive this; untrusted.
  explicit IccProfile(std::span<const uint8_t> bytes);

  // Whether the linear number that a sample, a fraction of the largest, stands for is `toLinear` of
  // it, to 0.003.
  bool decodesBy(const std::function<float(float)>& toLinear) const;

  // Whether colours have these primaries, nullopt: Rec. 709's. True of grey.
  bool has(const std::optional<Chromaticities>& primaries) const;

 private:
  std::span<const uint8_t> tag(const char* signature) const;

  std::span<const uint8_t> bytes_;
  bool isGrey_ = false;
};

}  // namespace chromeball
