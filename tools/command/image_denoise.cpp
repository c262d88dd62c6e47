// SPDX-License-Identifier: Apache-2.0
// chromeball image denoise IN OUT
#include "base/error.h"
#include "denoise/denoise.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "image_commands.h"

namespace chromeball {
namespace {

struct Arguments {
  std::string input, output;
};

Image layer(const ImageFile& file, const std::string& path, const std::string& name) {
  std::optional<Image> found = findLayer(file, name);
  if (!found) throwInput("{}: has no layer {}; render with --aov denoise", path, name);
  return *std::move(found);
}

void run(const Arguments& arguments) {
  const ImageFile file = readImageFile(arguments.input);
  const auto halved = [&](const std::string& name) {
    return HalvedImage{layer(file, arguments.input, "denoise." + name),
                       layer(file, arguments.input, "denoise." + name + "_half")};
  };
  DenoiseInput input;
  input.color = {*findColor(file), layer(file, arguments.input, "denoise.half")};
  input.direct = halved("direct");
  input.albedo = halved("albedo");
  input.normal = halved("normal");
  input.disparity = halved("disparity");
  const Denoised denoised = denoise(input, [](double) {});
  OutputImage output;
  output.layers.push_back({"", "RGB", denoised.color});
  output.layers.push_back({"denoise_error", "Y", denoised.error});
  writeImage(arguments.output, output);
}

}  // namespace

void addImageDenoiseCommand(CLI::App& image) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = image.add_subcommand("denoise", "Remove the noise of a render.");
  command->add_option("IN", arguments->input, "A render with --aov denoise, .exr")->required();
  command->add_option("OUT", arguments->output, "The denoised image")->required();
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
