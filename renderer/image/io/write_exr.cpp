// SPDX-License-Identifier: Apache-2.0
#include "image/io/write_exr.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/io/exr_state.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> channelNames(const OutputImage& output) {
  std::vector<std::string> names;
  for (const Layer& layer : output.layers) {
    if (layer.channels.empty()) names.push_back(layer.name);
    for (const char letter : layer.channels)
      names.push_back(layer.name.empty() ? std::string(1, letter) : layer.name + '.' + letter);
  }
  return names;
}

OIIO::ImageSpec specOf(const OutputImage& output) {
  const Image& color = output.layers.front().image;
  const std::vector<std::string> names = channelNames(output);
  OIIO::ImageSpec spec(color.width, color.height, int(names.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = names;
  if (const auto& placement = output.placement) {
    spec.x = placement->x, spec.y = placement->y;
    spec.full_width = placement->width, spec.full_height = placement->height;
  }
  spec.attribute("compression", "zip");
  for (const auto& [name, contents] : output.metadata)
    if (const auto* matrix = std::get_if<Matrix44>(&contents))
      spec.attribute(name, OIIO::TypeMatrix, matrix->data());
    else if (const auto* text = std::get_if<std::string>(&contents))
      spec.attribute(name, *text);
    else if (const auto* number = std::get_if<float>(&contents))
      spec.attribute(name, *number);
    else
      spec.attribute(name, std::get<int>(contents));
  return spec;
}

// All channels of the rows from `top` on, as many as `block` has.
void interleave(const OutputImage& output, int top, Image& block) {
  int offset = 0;
  for (const Layer& layer : output.layers) {
    for (int y = 0; y < block.height; ++y)
      for (int x = 0; x < block.width; ++x)
        std::copy_n(layer.image.at(x, top + y), layer.image.channels, block.at(x, y) + offset);
    offset += layer.image.channels;
  }
}

}  // namespace

void writeExr(const fs::path& path, const OutputImage& output) {
  AtomicFile file(path);
  const auto out = OIIO::ImageOutput::create("openexr");
  if (!out) throwRun("{}: this build of OpenImageIO does not write OpenEXR", path.string());
  const auto check = [&](bool ok) {
    if (ok) return;
    const std::string reason = out->geterror();
    throwRun("{}: cannot be written: {}", path.string(),
             reason.empty() ? std::strerror(errno) : reason);
  };
  const OIIO::ImageSpec spec = specOf(output);
  check(out->open(file.temporary().string(), spec));
  constexpr int kRows = 256;  // enough for all threads: they compress 16 at a time
  for (int top = 0; top < spec.height; top += kRows) {
    Image block(spec.width, std::min(kRows, spec.height - top), spec.nchannels);
    interleave(output, top, block);
    check(out->write_scanlines(spec.y + top, spec.y + top + block.height, 0, OIIO::TypeDesc::FLOAT,
                               block.texels.data()));
  }
  check(out->close());
  if (output.state) appendExrState(file.temporary(), path, output.state);
  file.commit();
}

}  // namespace chromeball
