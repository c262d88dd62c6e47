// SPDX-License-Identifier: Apache-2.0
// chromeball image denoise IN OUT
#include <cmath>

#include "base/error.h"
#include "denoise/denoise.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "image_commands.h"
#include "job/output_file.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

struct Arguments {
  std::string input, output;
  bool quiet = false;
};

struct Reader {
  const std::string& path;
  const ImageFile& file;

  Image layer(const std::string& name, int channels) const {
    std::optional<Image> found = findLayer(file, name);
    if (!found || found->channels != channels)
      throwInput("{}: has no layer {} of {} channels; render with --aov denoise", path, name,
                 channels);
    return finite(*std::move(found), name);
  }
  HalvedImage halved(const std::string& name, int channels) const {
    return {layer("denoise." + name, channels), layer("denoise." + name + "_half", channels)};
  }
  Image finite(Image image, const std::string& name) const {
    for (const float texel : image.texels)
      if (!std::isfinite(texel)) throwInput("{}: {} has infinite or NaN texels", path, name);
    return image;
  }
};

Image colorOf(const Image& image) {
  Image color(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) color.setRgb(x, y, image.rgb(x, y));
  return color;
}

void run(const Arguments& arguments) {
  checkWritable(arguments.output);
  checkDistinct({arguments.output}, {arguments.input});
  ImageFile file = readImageFile(arguments.input);
  const Reader reader{arguments.input, file};
  const std::optional<Image> found = findColorAndAlpha(file);
  if (!found) throwInput("{}: has no color", arguments.input);
  const std::optional<Image> noisy = findLayer(file, "noisy");  // of a denoised file
  const DenoiseInput input{.color = {reader.finite(colorOf(noisy ? *noisy : *found), "the color"),
                                     reader.layer("denoise.half", 3)},
                           .direct = reader.halved("direct", 3),
                           .albedo = reader.halved("albedo", 3),
                           .normal = reader.halved("normal", 3),
                           .disparity = reader.halved("disparity", 1)};
  Denoised denoised = [&] {
    ProgressBar bar(!arguments.quiet && ProgressBar::isTerminal());
    return denoise(input, [&](double fraction) { bar.update(fraction); });
  }();
  Image color = *found;
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) color.setRgb(x, y, denoised.color.rgb(x, y));
  OutputImage output;
  output.metadata = std::move(file.metadata);
  output.metadata["denoised_noise"] = float(remainingNoise(denoised));
  if (!arguments.quiet)
    fmt::print("noise about {:.2f}%: {}\n", 100 * remainingNoise(denoised), arguments.output);
  output.layers.push_back({"", color.channels == 4 ? "RGBA" : "RGB", std::move(color)});
  output.layers.push_back({"noisy", "RGB", input.color.mean});
  output.layers.push_back({"denoise_error", "Y", std::move(denoised.error)});
  writeImage(arguments.output, output);
}

}  // namespace

void addImageDenoiseCommand(CLI::App& image) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = image.add_subcommand(
      "denoise", "Remove noise from a render (biased), and estimate the error that remains.");
  command->add_option("IN", arguments->input, "A render with --aov denoise, .exr")->required();
  command
      ->add_option("OUT", arguments->output,
                   "The image to write; an .exr also has the layers noisy and denoise_error")
      ->required();
  command->add_flag("--quiet", arguments->quiet, "Show neither progress nor the noise");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
