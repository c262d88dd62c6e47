// SPDX-License-Identifier: Apache-2.0
#include "image/io/write_exr.h"

#include "image/io/exr_rows_writer.h"

namespace chromeball {
namespace {

std::vector<std::string> channelsOf(const OutputImage& output) {
  std::vector<std::string> names;
  for (const Layer& layer : output.layers) {
    if (layer.channels.empty()) names.push_back(layer.name);
    for (const char letter : layer.channels)
      names.push_back(layer.name.empty() ? std::string(1, letter) : layer.name + '.' + letter);
  }
  return names;
}

}  // namespace

void writeExr(const std::filesystem::path& path, const OutputImage& output) {
  const Image& first = output.layers.front().image;
  ExrRowsWriter writer(path, {.width = first.width,
                              .height = first.height,
                              .channels = channelsOf(output),
                              .metadata = output.metadata,
                              .placement = output.placement});
  std::vector<const Image*> images;
  for (const Layer& layer : output.layers) images.push_back(&layer.image);
  writer.write(images);
  writer.commit(output.state);
}

}  // namespace chromeball
