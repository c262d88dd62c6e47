// SPDX-License-Identifier: Apache-2.0
#include "image_render.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/json.h"
#include "base/text.h"
#include "image/io/output_file.h"
#include "messages.h"
#include "noise_in_words.h"
#include "session/develop_image.h"
#include "session/image_header.h"
#include "viewers/viewers.h"

namespace chromeball {
namespace {

std::string guidedInWords(const RenderResult& render) {
  const bool lights = render.guidedRegions > 0, bounces = render.causticFraction > 0;
  if (!lights && !bounces) return "";
  return fmt::format(", {} guided,", !bounces  ? "light samples"
                                     : !lights ? "bounces"
                                               : "light samples and bounces");
}

}  // namespace

std::string ImageRender::PassReport::of(const RenderResult& result) {
  const RayCounts& counts = result.rays;
  const uint64_t rays = counts.camera + counts.shadow + counts.bounce;
  std::string text = fmt::format("{} samples", result.samples);
  if (const Noise noise = result.film.noise(); !std::isnan(noise.noise))
    text += fmt::format(", noise {:.2g}%", 100 * noise.noise);
  if (rays_ > 0)  // a render that was resumed has rays of other times
    text += fmt::format(", {:.1f} M rays/s", 1e-6 * double(rays - rays_) / watch_.seconds());
  rays_ = rays;
  watch_ = Stopwatch();
  return text;
}

ImageRender::ImageRender(const LoadedScene& loaded, std::vector<Viewer*> viewers)
    : loaded_(loaded),
      viewers_(std::move(viewers)),
      bar_(progressStyle()),
      control_(
          loaded,
          [this](const RenderState& state) {
            if (progressStyle() != ProgressStyle::None) bar_.describe(report_.of(state.result));
          },
          viewers_) {}

FinishedRender ImageRender::run(const PreparedScene& prepared,
                                const std::function<double(double)>& fractionOfAll,
                                const Stop& stop) {
  const RenderDescription& description = loaded_.description;
  for (Viewer* viewer : viewers_) viewer->begin(description.output.files.front());
  const auto progress = [&](double fraction) {
    bar_.update(fractionOfAll(fraction));
    for (Viewer* viewer : viewers_) viewer->update(fraction);
  };
  const bool isReference = description.composite && description.composite->passes == Passes::Two;
  FinishedRender result =
      renderLoaded(loaded_, prepared, progress, stop, isReference ? nullptr : &control_);
  result.image.metadata = imageMetadata(loaded_, result, result.render, result.seconds);
  const Messages& more = control_.messages();
  result.messages.insert(result.messages.end(), more.begin(), more.end());
  if (!viewers_.empty()) {
    auto last = std::make_shared<ImageSoFar>(imageSoFar(result, result.render));
    last->isLast = true;
    for (Viewer* viewer : viewers_) viewer->show(last);
  }
  return result;
}

std::optional<RenderPart> identified(const LoadedScene& loaded) {
  if (!loaded.description.settings.isPart()) return {};
  return RenderPart{renderIdentity(loaded), {}};
}

void addState(const LoadedScene& loaded, std::optional<RenderPart>& part, FinishedRender& result) {
  if (!part) return;
  part->plan = finishPlan(loaded, result.render);
  result.image.state = partState(*part, result.render);
}

void writeImages(const RenderDescription& description, const LoadedScene& loaded,
                 const FinishedRender& result, PhaseSeconds seconds) {
  Stopwatch watch;
  print(writeOutputs(description, result.image));
  if (const auto& map = description.output.noiseMap) writeNoiseMap(*map, result);
  seconds.render = result.seconds;
  seconds.write = watch.lap();
  if (const auto& stats = description.output.stats)
    writeText(*stats, jsonText(statistics(loaded, result, seconds), 2) + "\n");
}

void printOutcome(const RenderDescription& description, const FinishedRender& result,
                  std::optional<float> exposure) {
  const RenderResult& render = result.render;
  if (render.interrupted && render.samples == 0)
    throw Interrupted(fmt::format("interrupted before every pixel had a sample; saved as {}",
                                  fmt::join(description.output.files, ", ")));
  const auto& checkpoint = description.run.checkpoint;
  if (render.interrupted)
    throw Interrupted(
        fmt::format("interrupted; the image so far, of {} samples per pixel{}, is saved "
                    "as {}{}",
                    render.samplesPerPixel(),
                    result.denoised                ? ", denoised"
                    : description.settings.denoise ? ", not denoised"
                                                   : "",
                    fmt::join(description.output.files, ", "),
                    checkpoint && std::filesystem::exists(*checkpoint)
                        ? fmt::format("; --resume goes on from {}", *checkpoint)
                        : ""));
  say("{} samples per pixel{} in {:.2f} s, noise {}{}: {}\n", render.samplesPerPixel(),
      guidedInWords(render), result.seconds, noiseInWords(result),
      exposure ? ", " + chosenInWords(*exposure) : "",
      printable(fmt::format("{}", fmt::join(description.output.files, ", "))));
}

}  // namespace chromeball
