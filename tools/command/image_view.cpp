// SPDX-License-Identifier: Apache-2.0
// chromeball image view IN OUT.png
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "commands.h"
#include "display_options.h"
#include "front/plan_render.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "layer_view.h"
#include "messages.h"
#include "session/image_header.h"

namespace chromeball {
namespace {

struct ImageViewArguments {
  std::string in, out, layer;
  Settings display;
};

// Prints the color of each name.
void printLegend(const Image& ids, const std::map<int, std::string>& names) {
  constexpr size_t kMax = 64;
  std::set<int> present;
  for (const float id : ids.texels)
    if (id >= 1 && id < 1e9f) present.insert(int(id));
  size_t shown = 0;
  for (const int id : present) {
    if (++shown > kMax) break;
    const auto name = names.find(id);
    const Color8 c = idColor(id);
    say("#{:02x}{:02x}{:02x}  {}  {}\n", c[0], c[1], c[2], id,
        name == names.end() ? "" : printable(name->second));
  }
  if (present.size() > kMax) say("and {} more\n", present.size() - kMax);
}

Image viewOf(const ImageFile& file, const std::string& path, const std::string& layer) {
  std::optional<Image> image = findLayer(file, layer);
  if (!image) {
    const std::vector<std::string> names = layerNames(file);
    const std::vector<std::string_view> known(names.begin(), names.end());
    throwInput("{}: has no layer `{}`; {}", path, layer,
               known.empty() ? "it has only its colour" : didYouMean(layer, known));
  }
  if (isOfIds(layer)) printLegend(*image, readManifest(file.metadata, layer));
  return inDisplayWindow(layerView(layer, *std::move(image)), file.placement, path);
}

void run(const ImageViewArguments& arguments) {
  checkOutputFile(arguments.out, {".png"});
  checkDistinct({arguments.out}, {arguments.in});
  const bool isLayer = !arguments.layer.empty();
  ImageFile file = openImageFile(arguments.in);
  const DisplayTransform transform = isLayer ? planDisplay(arguments.display).transform
                                             : displayOf(arguments.display, file, arguments.in);
  const Image shown = isLayer ? viewOf(file, arguments.in, arguments.layer)
                              : colorAndAlphaOf(std::move(file), arguments.in);
  print(writeImage(arguments.out, shown, transform));
}

}  // namespace

void addImageViewCommand(Command image) {
  auto [command, a] =
      image.addCommand<ImageViewArguments>("view", "Convert an image for display.", run);
  command.addRequired("IN", a.in, "The image");
  command.addRequired("OUT", a.out, "The image to write, .png");
  addDisplayOptions(command, a.display);
  command.addOption(
      "--layer", a.layer,
      "A layer in place of the colour: albedo, normal (-1..1 as 0..1), depth (near is white), node "
      "and material (one colour each, printed with its name), variance, samples, ...");
}

}  // namespace chromeball
