// chromeball image view IN OUT.png
#include <algorithm>
#include <cmath>
#include <limits>

#include "image/read.h"
#include "image/write.h"
#include "image_commands.h"
#include "math/error.h"
#include "math/suggest.h"
#include "output_file.h"

namespace chromeball {
namespace {

struct Arguments {
  std::string in, out, layer, tone = "none";
  float exposure = 0;
};

// What is far enough to mean "nothing was hit".
constexpr float kBackground = 1e9f;

// Nearest white, farthest black; the background black too.
void normaliseDepth(Image& depth) {
  float nearest = std::numeric_limits<float>::max(), farthest = 0;
  for (const float d : depth.texels)
    if (d < kBackground) nearest = std::min(nearest, d), farthest = std::max(farthest, d);
  const float range = std::max(farthest - nearest, 1e-20f);
  for (float& d : depth.texels) d = d < kBackground ? 1 - 0.95f * (d - nearest) / range : 0;
}

Image colorOf(const std::string& path) {
  ImageFile file = readImageFile(path);
  if (std::optional<Image> color = findColorAndAlpha(file)) return *std::move(color);
  return colorOf(std::move(file), path);
}

Image viewOf(const std::string& path, const std::string& layer) {
  const ImageFile file = readImageFile(path);
  std::optional<Image> image = findLayer(file, layer);
  if (!image) {
    const std::vector<std::string> names = layerNames(file);
    const std::vector<std::string_view> known(names.begin(), names.end());
    throwInput("{}: has no layer `{}`; {}", path, layer,
               known.empty() ? "it has only its colour" : didYouMean(layer, known));
  }
  if (layer == "depth") normaliseDepth(*image);
  if (layer == "normal")
    for (float& component : image->texels) component = 0.5f * (component + 1);
  return *std::move(image);
}

void run(const Arguments& arguments) {
  checkWritable(arguments.out);
  checkDistinct({arguments.out}, {arguments.in});
  const DisplayTransform transform{parseToneOperator(arguments.tone), arguments.exposure};
  if (!std::isfinite(transform.exposure)) throwInput("--exposure: should be a number of stops");
  writeImage(
      arguments.out,
      arguments.layer.empty() ? colorOf(arguments.in) : viewOf(arguments.in, arguments.layer),
      transform);
}

}  // namespace

void addImageViewCommand(CLI::App& image) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = image.add_subcommand("view", "Make an image that a screen can show.");
  command->add_option("IN", arguments->in, "the image")->required();
  command->add_option("OUT", arguments->out, "the image to write, .png")->required();
  command->add_option("--exposure", arguments->exposure, "stops: radiance times 2^STOPS");
  command->add_option("--tonemap", arguments->tone, "none, reinhard, aces, neutral or filmic")
      ->capture_default_str();
  command->add_option("--layer", arguments->layer,
                      "albedo, normal (-1..1 shown as 0..1), depth (near is white), variance, ...");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace chromeball
