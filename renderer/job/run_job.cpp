// SPDX-License-Identifier: Apache-2.0
#include "job/run_job.h"

#include "base/stopwatch.h"
#include "job/denoised_image.h"
#include "job/run_composite.h"

namespace chromeball {
namespace {

Image withAlpha(const Image& color, const Image& alpha) {
  Image image(color.width, color.height, 4);
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      image.setRgb(x, y, color.rgb(x, y));
      image.at(x, y)[3] = *alpha.at(x, y);
    }
  return image;
}

// The layers that `chromeball image denoise` reads.
void addFeatures(const RenderResult& result, OutputImage& output) {
  const auto add = [&](const std::string& name, const char* channels, HalvedImage image) {
    output.layers.push_back({"denoise." + name, channels, std::move(image.mean)});
    output.layers.push_back({"denoise." + name + "_half", channels, std::move(image.half)});
  };
  output.layers.push_back({"denoise.half", "RGB", result.film.halfDifference()});
  add("direct", "RGB", result.features.direct());
  add("albedo", "RGB", result.features.albedo());
  add("normal", "XYZ", result.features.normal());
  add("disparity", "Y", result.features.disparity());
}

OutputImage assemble(const RenderResult& result, const RenderSettings& settings,
                     const Image& variance) {
  OutputImage output;
  if (settings.hideProbe)
    output.layers.push_back(
        {"", "RGBA", withAlpha(result.film.mean(), result.aovs.finished(Aov::Alpha))});
  else
    output.layers.push_back({"", "RGB", result.film.mean()});
  for (Aov aov : settings.aovs) {
    if (aov == Aov::Denoise) {
      addFeatures(result, output);
      continue;
    }
    const AovInfo& info = aovInfo(aov);
    output.layers.push_back({info.name, info.channels,
                             aov == Aov::Variance  ? variance
                             : aov == Aov::Samples ? result.film.sampleCounts()
                                                   : result.aovs.finished(aov)});
  }
  return output;
}

JobResult renderPlain(const RenderJob& job, const LoadedScene& loaded,
                      const PreparedScene& prepared, const Progress& progress,
                      const std::atomic<bool>& stop) {
  const bool denoises = job.settings.denoise;
  const double share = denoises ? kRenderShare : 1;
  RenderResult result = render(
      *prepared.world, loaded.camera, *prepared.lighting, job.settings,
      [&](double fraction) { progress(share * fraction); }, stop);
  ImageNoise noise(result.film.errors());
  OutputImage image = assemble(result, job.settings, noise.variance);
  std::optional<DenoiseReport> report;
  if (denoises && !result.interrupted)
    report = addDenoised([&](const Progress& part) { return denoiseRender(result, part, stop); },
                         progress, image);
  result.interrupted |= denoises && !report;
  return {std::move(image), std::move(result), std::move(noise), {}, report, {}};
}

}  // namespace

PreparedScene prepareScene(const RenderJob& job, const LoadedScene& loaded) {
  Stopwatch watch;
  PreparedScene prepared;
  prepared.world = std::make_unique<const World>(
      loaded.scene, job.composite ? rayMasks(loaded.isObject) : std::vector<RayMask>(),
      BsdfTables(loaded.scene.materials, job.settings.regularize));
  prepared.buildSeconds = watch.lap();
  prepared.lighting = makeLighting(job.strategy, job.settings.mis, loaded);
  prepared.prepareSeconds = watch.lap();
  return prepared;
}

JobResult renderJob(const RenderJob& job, const LoadedScene& loaded, const PreparedScene& prepared,
                    const Progress& progress, const std::atomic<bool>& stop) {
  Stopwatch watch;
  JobResult result = job.composite ? renderComposite(job, loaded, prepared, progress, stop)
                                   : renderPlain(job, loaded, prepared, progress, stop);
  result.seconds = watch.lap();
  return result;
}

JobResult renderJob(const RenderJob& job, const LoadedScene& loaded) {
  const std::atomic<bool> never = false;
  return renderJob(
      job, loaded, prepareScene(job, loaded), [](double) {}, never);
}

}  // namespace chromeball
