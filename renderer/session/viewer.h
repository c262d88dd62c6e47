// SPDX-License-Identifier: Apache-2.0
// A viewer of an image while it is rendered: a page in a browser, or another program.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "session/finish.h"

namespace chromeball {

struct ImageSoFar {
  OutputImage image;     // denoised only at the end
  uint32_t samples = 0;  // mean per pixel
  double noise = 0;     // of the colour before denoising (film/noise.h); a fraction, NaN if unknown
  bool isLast = false;  // of this render
};

// Includes the layers variance and samples, even if the description does not ask for them.
inline ImageSoFar imageSoFar(FinishedImage finished, const RenderResult& render) {
  std::vector<Layer>& layers = finished.image.layers;
  const auto has = [&](const char* name) {
    return std::ranges::any_of(layers, [&](const Layer& layer) { return layer.name == name; });
  };
  if (!has("variance")) layers.push_back({"variance", "RGB", std::move(finished.noise.variance)});
  if (!has("samples")) layers.push_back({"samples", "", render.film.sampleCounts()});
  return {std::move(finished.image), render.samplesPerPixel(), finished.noise.noise};
}

class Viewer {
 public:
  virtual ~Viewer() = default;

  // A render begins; `name` is its first output file's.
  virtual void begin(const std::string& name) = 0;
  // The fraction of the render's work done; NaN if unknown. Thread-safe.
  virtual void update(double fraction) = 0;

  // Whether a newer image is wanted. Thread-safe and fast: called after each tile.
  virtual bool wantsImage() const = 0;
  virtual void show(std::shared_ptr<const ImageSoFar> image) = 0;

  // Whether the output files shall be written now. Thread-safe and fast.
  virtual bool wantsFiles() const { return false; }
  virtual void wroteFiles() {}
};

}  // namespace chromeball
