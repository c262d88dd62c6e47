// SPDX-License-Identifier: Apache-2.0
// chromeball image divide A B -o OUT.exr
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "commands.h"
#include "image/flat_field.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"

namespace chromeball {
namespace {

struct ImageDivideArguments {
  std::string a, b, output;
};

void run(const ImageDivideArguments& arguments) {
  checkWritable(arguments.output);
  checkDistinct({arguments.output}, {arguments.a, arguments.b});
  ImageFile file = openImageFile(arguments.a);
  const Image b = openImage(arguments.b);
  OutputImage output;
  output.metadata = keptMetadata(file.metadata, arguments.a, arguments.output);
  std::optional<Image> clipped = layerOf(file, "clipped", arguments.a);
  std::vector<std::string> others = layerNames(file);
  std::erase(others, "clipped");
  if (!others.empty())
    print(Messages{makeNote("{}: its colour alone is divided and written; without the layers {}",
                            arguments.a, fmt::join(others, ", "))});
  Image a = colorAndAlphaOf(std::move(file), arguments.a);
  if (a.width != b.width || a.height != b.height)
    throwInput("{}: is {} x {}, but {} is {} x {}; only images of the same size can be divided",
               arguments.a, a.width, a.height, arguments.b, b.width, b.height);
  if (const size_t undivided = divide(a, b); undivided > 0)
    warn("{}: {} pixels have a channel that is not above 0; the result is 0 there", arguments.b,
         undivided);
  const auto invalid = std::ranges::count_if(a.texels, [](float x) { return !std::isfinite(x); });
  if (invalid > 0)
    throwInput(
        "{}: {} channels divided by {} are NaN or infinite: such texels, or results above the "
        "largest float, 3.4e38",
        arguments.a, invalid, arguments.b);
  output.layers.push_back({"", a.channels == 4 ? "RGBA" : "RGB", std::move(a)});
  if (clipped) output.layers.push_back({"clipped", "", *std::move(clipped)});
  writeKept(arguments.output, std::move(output), arguments.a);
}

}  // namespace

void addImageDivideCommand(Command image) {
  auto [command, a] =
      image.addCommand<ImageDivideArguments>("divide",
                                             "Divide the colour of an image by that of another, in "
                                             "linear light: a photograph by its flat field.",
                                             run);
  command.addRequired("A", a.a, "the image; its alpha and its layer `clipped` are kept");
  command.addRequired("B", a.b, "what to divide by");
  command.addRequired("-o,--output", a.output, "the image to write: .exr, .hdr, .pfm or .png");
}

}  // namespace chromeball
