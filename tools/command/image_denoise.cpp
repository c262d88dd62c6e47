// SPDX-License-Identifier: Apache-2.0
// chromeball image denoise IN OUT
#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "commands.h"
#include "denoise/denoise.h"
#include "image/io/output_file.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "noise_in_words.h"
#include "progress_bar.h"
#include "session/denoised_image.h"
#include "session/memory_estimate.h"
#include "session/render_report.h"

namespace chromeball {
namespace {

struct ImageDenoiseArguments {
  std::string input, output;
};

// No number in a render is as large.
constexpr float kMaxRadiance = 1e15f, kMaxUnit = 1e6f;

struct Reader {
  const std::string& path;
  const ImageFile& file;

  Image layer(const std::string& name, int channels, float limit = kMaxRadiance) const {
    std::optional<Image> found = findLayer(file, name);
    if (!found || found->channels != channels)
      throwInput("{}: has no layer {} of {} channels; render with --aov denoise", path, name,
                 channels);
    return checked(*std::move(found), name, limit);
  }
  HalvedImage halved(const std::string& name, int channels, float limit = kMaxRadiance) const {
    return {layer("denoise." + name, channels, limit),
            layer("denoise." + name + "_half", channels, limit)};
  }
  Image checked(Image image, const std::string& name, float limit) const {
    for (const float texel : image.texels)
      if (!(std::fabs(texel) < limit))
        throwInput("{}: {} has infinite, NaN or huge texels", path, name);
    return image;
  }
  // The colour of the noisy image; in a denoised file it is a layer.
  Image color() const {
    if (std::ranges::count(layerNames(file), "noisy") > 0) return layer("noisy", 3);
    for (const char* channel : {"R", "G", "B"})
      if (std::ranges::count(file.channels, channel) == 0)
        throwInput("{}: has no channel {}", path, channel);
    return checked(*findColor(file), "the colour", kMaxRadiance);
  }
};

Image withColor(Image image, const Image& color) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) image.setRgb(x, y, color.rgb(x, y));
  return image;
}

void checkMemory(const std::string& path, const Image& color) {
  const double needed = denoiseBytes(color.width, color.height, 2);
  if (needed > memoryBudget())
    throwInput("{}: denoising {}x{} pixels takes {:.3g} GB of memory", path, color.width,
               color.height, needed * 1e-9);
}

void run(const ImageDenoiseArguments& arguments) {
  checkWritable(arguments.output);
  checkDistinct({arguments.output}, {arguments.input});
  ImageFile file = readImageFile(arguments.input);
  const Reader reader{arguments.input, file};
  const HalvedImage color{reader.color(), reader.layer("denoise.half", 3)};
  const DenoiseInput input{.parts = directAndIndirect(color, reader.halved("direct", 3)),
                           .albedo = reader.halved("albedo", 3, kMaxUnit),
                           .normal = reader.halved("normal", 3, kMaxUnit),
                           .disparity = reader.halved("disparity", 1)};
  print(file.messages);  // not of a file that lacks layers: that is said instead
  checkMemory(arguments.input, color.mean);
  const std::atomic<bool> never = false;
  Denoised denoised = [&] {
    ProgressBar bar(progressStyle(), "denoising");
    return sumOf(*denoise(
        input, [&](double fraction) { bar.update(fraction); }, never));
  }();
  OutputImage output;
  output.metadata = keptMetadata(file.metadata, arguments.input, arguments.output);
  output.placement = file.placement;
  Image noisy = withColor(*findColorAndAlpha(file), color.mean);
  output.layers.push_back({"", noisy.channels == 4 ? "RGBA" : "RGB", std::move(noisy)});
  const auto before = [&](const char* name) {
    return metadataNumber(output.metadata, name).value_or(NAN);
  };
  const DenoiseReport report = addDenoised(
      std::move(denoised), {before("noise"), before("noise_median"), before("noise_p95")}, output);
  addNoise(report, output.metadata);
  writeKept(arguments.output, std::move(output), arguments.input);
  say("noise {}: {}\n",
      std::isfinite(report.noise) ? "about " + inWords(report, report.relative) : "unknown",
      printableName(arguments.output));
}

}  // namespace

void addImageDenoiseCommand(Command image) {
  auto [command, a] = image.addCommand<ImageDenoiseArguments>(
      "denoise", "Remove noise from a render (biased), and estimate the error that remains.", run);
  command.addRequired("IN", a.input, "A render with --aov denoise, .exr");
  command.addRequired("OUT", a.output,
                      "The image to write; an .exr also has the layers noisy and denoise_error");
}

}  // namespace chromeball
