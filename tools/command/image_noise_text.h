// SPDX-License-Identifier: Apache-2.0
// The noise of an image in words.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

#include "session/denoised_image.h"

namespace chromeball {

inline std::string inWords(const ImageNoise& n) {
  if (!std::isfinite(n.noise)) return "unknown";
  return fmt::format("{:.2f}% (median of the pixels {:.2f}%, 95% of them below {:.2f}%)",
                     100 * n.noise, 100 * n.median, 100 * n.p95);
}

inline std::string inWords(const std::optional<DenoiseReport>& denoised) {
  if (!denoised) return "";
  if (!std::isfinite(denoised->noise)) return "; denoised";
  return fmt::format("; denoised to about {:.2f}%", 100 * denoised->noise);
}

}  // namespace chromeball
