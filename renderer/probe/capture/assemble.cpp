// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/assemble.h"

#include "base/parallel.h"
#include "probe/probe.h"
#include "probe/solid_angle.h"

namespace chromeball {

Assembly assemble(const std::vector<CaptureView>& views, const ImageSize& size) {
  double pixels = 0;
  for (const CaptureView& view : views) pixels = std::max(pixels, view.pixelsOfSphere());
  const double perTexel = pixels / (double(size.width) * size.height);
  const int samples = std::max(2, int(std::ceil(2 * std::sqrt(perTexel))));

  Assembly assembly{Image(size.width, size.height, 3), Image(size.width, size.height, 1)};
  std::vector<double> blind(size_t(size.height));  // solid angle by row
  parallelFor(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      dvec3 sum(0);
      double shown = 0, all = 0;
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) {
          const dvec2 uv((x + (i + 0.5) / samples) / size.width,
                         (y + (j + 0.5) / samples) / size.height);
          const double w = std::sin(kPiD * uv.y);
          all += w;
          const CaptureView::Sample sample = merged(views, *uvToDirection(Mapping::LatLong, uv));
          if (sample.weight == 0) continue;
          shown += w;
          sum += w * sample.radiance;
        }
      if (shown > 0) assembly.latLong.setRgb(x, y, Rgb(sum / shown));
      *assembly.coverage.at(x, y) = float(shown / all);
      blind[size_t(y)] += (1 - shown / all) * texelSolidAngle(y, size.width, size.height);
    }
  });
  for (const double solidAngle : blind) assembly.blindShare += solidAngle / (4 * kPiD);
  return assembly;
}

ImageSize assemblySize(const std::vector<CaptureView>& views) {
  constexpr double kMostRows = 8192;
  double pixels = 1;
  for (const CaptureView& view : views) pixels = std::max(pixels, view.pixelsOfSphere());
  // A pixel covers 4 pi / pixels, a texel at the horizon (pi / rows)^2.
  const double rows = std::min(0.5 * std::sqrt(kPiD * pixels), kMostRows);
  const int even = std::max(2, 2 * int(std::ceil(0.5 * rows - 1e-9)));
  return {2 * even, even};
}

void fillBlind(const BlindFill& fill, Assembly& assembly) {
  if (fill.isSmooth) return inpaintBlind(assembly);
  const std::optional<Probe> probe = fill.map ? std::optional<Probe>(*fill.map) : std::nullopt;
  const ImageSize size{assembly.latLong.width, assembly.latLong.height};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (*assembly.coverage.at(x, y) == 0)
        assembly.latLong.setRgb(
            x, y, probe ? probe->radiance(vec3(texelDirection(size, x, y))) : fill.color);
}

}  // namespace chromeball
