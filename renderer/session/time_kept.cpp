// SPDX-License-Identifier: Apache-2.0
#include "session/render_loaded.h"

#include <algorithm>

#include "base/file.h"
#include "base/progress.h"
#include "denoise/denoise.h"

namespace chromeball {
namespace {

// Measured, and rounded up.
constexpr double kSecondsPerPngByte = 5e-8, kSecondsPerExrChannel = 6e-8, kSecondsPerOther = 3e-8;
constexpr double kMostOfLimit = 0.75, kMargin = 1.15;

// An image whose neighbours differ, so that all of the filter runs.
Image patterned(int side) {
  Image image(side, side, 3);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = 0.5f + 0.01f * float(i % 7);
  return image;
}

double secondsPerPixel(size_t parts) {
  constexpr int kSide = 96;
  const HalvedImage image{patterned(kSide), Image(kSide, kSide, 3)};
  const HalvedImage disparity{Image(kSide, kSide, 1), Image(kSide, kSide, 1)};
  const std::atomic<bool> never = false;
  Stopwatch watch;
  denoise(
      {std::vector(parts, image), image, image, disparity}, [](double) {}, never);
  return watch.seconds() / (kSide * kSide);
}

double secondsPerPixelToWrite(const std::string& file, size_t layers) {
  const std::string kind = lowerExtension(file);
  if (kind == ".png") return 3 * kSecondsPerPngByte;
  return kind == ".exr" ? 3 * double(1 + layers) * kSecondsPerExrChannel : 3 * kSecondsPerOther;
}

}  // namespace

KeptTime keepTime(const RenderDescription& description) {
  KeptTime kept{description.settings};
  std::optional<double>& limit = kept.settings.timeLimit;
  if (!limit || description.output.files.empty()) return kept;
  const Crop window = kept.settings.window();
  const bool denoises = kept.settings.denoisesAtEnd();
  const size_t layers = description.output.layers.size() + (denoises ? 2 : 0);
  double perPixel = denoises ? kMargin * secondsPerPixel(description.composite ? 3 : 2) : 0;
  for (const std::string& file : description.output.files)
    perPixel += secondsPerPixelToWrite(file, layers);
  kept.seconds = std::min(kMostOfLimit * *limit, perPixel * window.width * window.height);
  *limit -= kept.seconds;
  return kept;
}

}  // namespace chromeball
