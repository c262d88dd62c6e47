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

std::vector<ChannelBlock> blocksOf(const OutputImage& output) {
  std::vector<ChannelBlock> blocks;
  for (const Layer& layer : output.layers) {
    std::vector<std::string> names;
    if (layer.channels.empty()) names.push_back(layer.name);
    for (const char letter : layer.channels)
      names.push_back(layer.name.empty() ? std::string(1, letter) : layer.name + '.' + letter);
    blocks.push_back({std::move(names), &layer.image});
  }
  return blocks;
}

OIIO::ImageSpec specOf(std::span<const ChannelBlock> blocks, const Metadata& metadata) {
  std::vector<std::string> names;
  for (const ChannelBlock& block : blocks)
    names.insert(names.end(), block.names.begin(), block.names.end());
  const Image& first = *blocks.front().image;
  OIIO::ImageSpec spec(first.width, first.height, int(names.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = names;
  spec.attribute("compression", "zip");
  for (const auto& [name, contents] : metadata)
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

// All channels of the rows from `top` on, as many as `rows` has.
void interleave(std::span<const ChannelBlock> blocks, int top, Image& rows) {
  int offset = 0;
  for (const ChannelBlock& block : blocks) {
    const int channels = block.image->channels;
    for (int y = 0; y < rows.height; ++y)
      for (int x = 0; x < rows.width; ++x)
        std::copy_n(block.image->at(x, top + y), channels, rows.at(x, y) + offset);
    offset += channels;
  }
}

// At least 16, which are compressed together; else about 64 MB of floats.
int rowsAtOnce(const OIIO::ImageSpec& spec) {
  constexpr int kMost = 256;  // enough for all threads
  const auto floatsPerRow = int64_t(spec.width) * spec.nchannels;
  return int(std::clamp<int64_t>((int64_t(1) << 24) / floatsPerRow, 16, kMost));
}

void write(const fs::path& path, std::span<const ChannelBlock> blocks, const OIIO::ImageSpec& spec,
           const std::function<void(Archive&)>& state) {
  AtomicFile file(path);
  const auto out = OIIO::ImageOutput::create("openexr");
  if (!out) throwRun("{}: this build of OpenImageIO does not write OpenEXR", path.string());
  const auto check = [&](bool ok) {
    if (ok) return;
    const std::string reason = out->geterror();
    throwRun("{}: cannot be written: {}", path.string(),
             reason.empty() ? std::strerror(errno) : reason);
  };
  check(out->open(file.temporary().string(), spec));
  const int most = rowsAtOnce(spec);
  for (int top = 0; top < spec.height; top += most) {
    Image rows(spec.width, std::min(most, spec.height - top), spec.nchannels);
    interleave(blocks, top, rows);
    check(out->write_scanlines(spec.y + top, spec.y + top + rows.height, 0, OIIO::TypeDesc::FLOAT,
                               rows.texels.data()));
  }
  check(out->close());
  if (state) appendExrState(file.temporary(), path, state);
  file.commit();
}

}  // namespace

void writeExr(const fs::path& path, const OutputImage& output) {
  const std::vector<ChannelBlock> blocks = blocksOf(output);
  OIIO::ImageSpec spec = specOf(blocks, output.metadata);
  if (const auto& placement = output.placement) {
    spec.x = placement->x, spec.y = placement->y;
    spec.full_width = placement->width, spec.full_height = placement->height;
  }
  write(path, blocks, spec, output.state);
}

void writeExr(const fs::path& path, std::span<const ChannelBlock> blocks, const Metadata& metadata,
              bool halves) {
  OIIO::ImageSpec spec = specOf(blocks, metadata);
  if (halves) spec.set_format(OIIO::TypeDesc::HALF);
  write(path, blocks, spec, {});
}

}  // namespace chromeball
