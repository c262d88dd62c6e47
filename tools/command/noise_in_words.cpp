// SPDX-License-Identifier: Apache-2.0
#include "noise_in_words.h"

#include <fmt/format.h>

#include <cmath>

#include "base/file.h"
#include "image/io/write_image.h"
#include "measure/false_color.h"

namespace chromeball {
namespace {

// Two digits or so: nobody reads more.
std::string percent(double fraction) {
  const double p = 100 * fraction;
  return p >= 9.95 ? fmt::format("{:.0f}%", p)
         : p >= 1  ? fmt::format("{:.1f}%", p)
                   : fmt::format("{:.2g}%", std::round(100 * p) / 100);
}

std::string place(const Image& relativeErrors) {
  const std::string_view part = noisiestPart(relativeErrors);
  return part.empty() ? "" : fmt::format(", mostly {}", part);
}

}  // namespace

std::string inWords(const NoiseFigures& noise, const Image& relativeErrors) {
  if (!std::isfinite(noise.median)) return "unknown";
  return fmt::format("{} in a typical pixel, above {} in the worst 5%{}", percent(noise.median),
                     percent(noise.p95), place(relativeErrors));
}

std::string noiseInWords(const FinishedImage& image) {
  if (!image.denoised) return inWords(image.noise, image.noise.relative);
  const std::string before = inWords(image.noise, {});
  const DenoiseReport& after = *image.denoised;
  if (!std::isfinite(after.median)) return before + "; denoised";
  return fmt::format("{}; denoised to about {}, and {} in the worst 5%{}", before,
                     percent(after.median), percent(after.p95), place(after.relative));
}

void writeNoiseMap(const std::string& path, const FinishedImage& image) {
  const NoiseMap map = noiseMap(image.denoised ? image.denoised->relative : image.noise.relative);
  writeFile(path, encodePng(map.width, map.height, 3, map.bytes));
}

}  // namespace chromeball
