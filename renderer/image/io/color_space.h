// SPDX-License-Identifier: Apache-2.0
// The colour space that a file of an image of light states: by an ICC profile, or by a PNG's
// chunks.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "image/chromaticities.h"
#include "image/io/read_image.h"
#include "image/tonemap.h"

namespace chromeball {

// ICC profiles (ISO 15076-1). They are not applied, but compared with what the texels are read as.

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

// The colour space that a PNG states (ISO/IEC 15948, 11.3.3; cICP: third edition), for images of
// light; textures of models ignore it (glTF 2.0, 3.8.2).

// The linear number that a sample, a fraction of the largest, stands for.
using DecodeSample = std::function<float(float)>;

struct PngColor {
  DecodeSample decode = srgbToLinear;
  std::optional<Chromaticities> primaries = {};  // nullopt: sRGB's
  std::optional<Transfer> transfer = {};         // nullopt: not stated, `decode` is of sRGB
};

// The colour space, from the chunk cICP, else from gAMA and cHRM, which sRGB overrides; they
// approximate an ICC profile (pngProfile()), which takes precedence but is not applied. Throws
// std::runtime_error for a cICP whose samples cannot be decoded here, such as PQ and HLG.
PngColor pngColor(std::span<const uint8_t> file);

}  // namespace chromeball
