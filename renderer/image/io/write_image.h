// SPDX-License-Identifier: Apache-2.0
// Writes image files. Every write is atomic: the file appears complete or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/archive.h"
#include "base/message.h"
#include "image/image.h"
#include "image/io/read_image.h"
#include "image/tonemap.h"

namespace chromeball {

// A group of channels. Each letter of `channels` is one: {"albedo", "RGB"} has the channels
// albedo.R, albedo.G, albedo.B. The colour has the empty name. {"samples", ""} is the single
// channel samples.
struct Layer {
  std::string name, channels;
  Image image;  // as many channels as letters, at least one
};

// Layers of one size; the first is the colour ("RGB" or "RGBA", or one letter for grey).
struct OutputImage {
  std::vector<Layer> layers;
  Metadata metadata;
  std::optional<Placement> placement;   // of an .exr
  std::function<void(Archive&)> state;  // further contents of an .exr (exr_state.h); may be empty
};

// Throws InputError unless `path` ends in .exr, .hdr, .pfm or .png.
void checkImageName(const std::filesystem::path& path);

// checkImageName() and checkReplaceable() (base/file.h), to be called before rendering.
void checkWritable(const std::filesystem::path& path);

// .exr: all layers and the metadata; float32, scanlines, ZIP. .hdr and .pfm: the colour, and in
// .hdr the metadata's `mapping` if it is a printable name. .png: the colour after `transform`, 8
// bits, sRGB, with unassociated alpha (the layer's colour is associated and is divided by alpha
// first). Returns warnings of what the file cannot hold (lostLight()).
// Throws as checkWritable() does, and RunError if writing fails.
Messages writeImage(const std::filesystem::path& path, const OutputImage& output,
                    const DisplayTransform& transform = {});

// The bytes of that .png. An image of one channel is grey. An exposure other than 0 is in the text
// `exposure`.
std::vector<uint8_t> encodePng(const Image& color, const DisplayTransform& transform);

// Writes only the colour.
Messages writeImage(const std::filesystem::path& path, const Image& color,
                    const DisplayTransform& transform = {});

// The parts of an image that a file cannot hold.

// Warnings of losses when the colour is written to `path`, each "FILE: ...": - in a .png, light
// where nothing covers the background, such as a caustic on a shadow catcher:
//   associated colour above alpha. A .png has unassociated colour, at most 1, so it holds no more
//   than alpha. Only where alpha is below one half: the rest is clipped as any bright surface is.
// - in an .hdr and a .pfm, alpha;
// - in a .png and an .hdr, negative channels, and those that are NaN;
// - in an .hdr, channels above the largest number of RGBE, and infinite ones.
Messages lostLight(const std::filesystem::path& path, const Image& color);

// Encodes a PNG in memory: for images embedded in documents, and for files.

// `bytes` are rows of interleaved 8-bit sRGB channels: one (grey), three, or four with unassociated
// alpha. The encoding is lossless. `exposure`: a text with this name; empty: none.
std::vector<uint8_t> encodePng(int width, int height, int channels, std::span<const uint8_t> bytes,
                               std::string exposure = "");

// Writes cube maps as KTX 2.0 (Khronos, "KTX File Format", version 2.0).

// `levels`: from the largest to the smallest, each half the size of the one before, six faces one
// below another in the order +X -X +Y -Y +Z -Z. Half floats, linear Rec. 709, alpha 1, not
// compressed. Channels beyond the range of a half are set to its ends; returns how many. The file
// appears complete or not at all. Throws RunError if writing fails.
size_t writeKtx2(const std::filesystem::path& path, const std::vector<const Image*>& levels);

}  // namespace chromeball
