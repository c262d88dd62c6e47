// SPDX-License-Identifier: Apache-2.0
#include "session/develop_image.h"

#include <algorithm>
#include <cmath>

#include "base/file.h"
#include "image/tonemap.h"

#include <fmt/format.h>

namespace chromeball {
namespace {

const Image* findDepth(const OutputImage& image) {
  for (const Layer& layer : image.layers)
    if (layer.name == "depth") return &layer.image;
  return nullptr;
}

// A finished render is written even if its camera does not allow the steps of developing.
DevelopSettings possible(DevelopSettings settings, const ViewFrame& frame, const Image* depth,
                         Messages& messages) {
  if (settings.needsFov() && !(frame.fov > 0)) {
    addWarning(messages,
               "develop: vignette, glare and depth-blur are left out: the camera has no field of "
               "view");
    settings.lens.reset(), settings.glare = false, settings.vignette = 0;
  }
  if (settings.lens && !depth) {
    addWarning(messages, "develop: depth-blur is left out: the image has no layer `depth`");
    settings.lens.reset();
  }
  return settings;
}

OutputImage developed(const RenderDescription& description, const OutputImage& image,
                      Messages& messages) {
  const Layer& color = image.layers.front();
  OutputImage result{{color}, image.metadata};
  const Image* depth = findDepth(image);
  const ViewFrame frame = viewFrame(color.image, image.placement, image.metadata);
  DevelopSettings settings = possible(description.output.develop, frame, depth, messages);
  if (settings.clip)  // a .png clips relative to its white
    *settings.clip *= std::exp2(-description.output.display.exposure);
  const Messages found = inWords(develop(result.layers.front().image, settings, depth, frame));
  messages.insert(messages.end(), found.begin(), found.end());
  return result;
}

}  // namespace

ViewFrame viewFrame(const Image& image, const std::optional<Placement>& placement,
                    const Metadata& metadata) {
  ViewFrame frame{0, 0, image.width, image.height, 0};
  if (placement) frame = {placement->x, placement->y, placement->width, placement->height, 0};
  const double fov = metadataNumber(metadata, "cameraFov").value_or(0);
  if (fov > 0 && fov < 180) frame.fov = fov;
  return frame;
}

Messages inWords(const DevelopReport& report) {
  Messages messages;
  if (report.invalid > 0)
    addWarning(messages, "develop: {} pixel{} NaN or infinite; as 0, they do not spread",
               report.invalid, report.invalid == 1 ? " is" : "s are");
  if (report.limited > 0)
    addWarning(messages, "develop: the depth blur of {} pixels is limited to a radius of {} pixels",
               report.limited, kMaxConfusionRadius);
  return messages;
}

Messages writeOutputs(const RenderDescription& description, const OutputImage& image) {
  Messages messages;
  std::optional<OutputImage> shown;
  for (const std::string& path : description.output.files) {
    const bool isShown = lowerExtension(path) == ".png" && !description.output.develop.isEmpty();
    if (isShown && !shown) shown = developed(description, image, messages);
    const Messages lost = writeImage(path, isShown ? *shown : image, description.output.display);
    messages.insert(messages.end(), lost.begin(), lost.end());
    const bool isCatcher =
        description.composite && description.composite->mode == CompositeMode::ShadowCatcher;
    if (isCatcher && lowerExtension(path) == ".png")
      addNote(messages,
              "{}: its shadows are right where images are laid over others in linear light, as "
              "compositing programs do; where sRGB codes are mixed, as in most image editors, they "
              "are much too dark",
              path);
  }
  return messages;
}

namespace {

constexpr double kPixels = 96 * 64;
constexpr uint32_t kSamples = 32;  // per pixel

// What decides the light stays as it is.
RenderSettings meterSettings(RenderSettings settings) {
  const double scale =
      std::min(1.0, std::sqrt(kPixels / (double(settings.width) * settings.height)));
  settings.width = std::max(1, int(std::lround(scale * settings.width)));
  settings.height = std::max(1, int(std::lround(scale * settings.height)));
  settings.crop.reset(), settings.shard = {}, settings.seed = 0;
  settings.samples = kSamples, settings.timeLimit.reset(), settings.noiseLimit.reset();
  settings.adaptive = settings.denoise = settings.lightGroups = settings.shadowMattes = false;
  settings.guiding = Guiding::Off, settings.cacheError.reset();
  settings.aovs = {Aov::Alpha};
  return settings;
}

}  // namespace

bool needsExposure(const RenderDescription& description) {
  const auto isPng = [](const std::string& file) { return lowerExtension(file) == ".png"; };
  return description.output.choosesExposure &&
         (description.settings.isPart() || description.run.checkpoint ||
          std::ranges::any_of(description.output.files, isPng));
}

float meteredExposure(const LoadedScene& loaded, const PreparedScene& prepared,
                      const std::atomic<bool>& stop) {
  const RenderResult small = render(*prepared.world, loaded.camera, *prepared.lighting,
                                    meterSettings(loaded.description.settings), [](double) {}, stop,
                                    nullptr, {prepared.environment.get(), nullptr});
  if (small.interrupted) return 0;
  return autoExposure(small.film.mean(), small.aovs.finished(Aov::Alpha));
}

std::string chosenInWords(float exposure) {
  return fmt::format("exposure {:+.1f} stops (auto)", exposure);
}

}  // namespace chromeball
