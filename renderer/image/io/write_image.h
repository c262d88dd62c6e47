// SPDX-License-Identifier: Apache-2.0
// Writing images. Every write is atomic: the file appears whole, or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"
#include "image/io/read_image.h"
#include "image/tonemap.h"

namespace chromeball {

// Some channels of a file: `channels` names each by a letter, so {"albedo", "RGB"} is albedo.R,
// albedo.G, albedo.B. The colour itself has the empty name; {"samples", ""} is one channel,
// samples.
struct Layer {
  std::string name, channels;
  Image image;  // as many channels as letters (at least one)
};

// Layers of one size, the colour ("RGB" or "RGBA", or one letter for grey) first.
struct OutputImage {
  std::vector<Layer> layers;
  Metadata metadata;
};

// Throws InputError unless `path` ends in .exr, .hdr, .pfm or .png.
void checkImageName(const std::filesystem::path& path);

// The same; and throws as checkReplaceable (base/file.h) does. Ask this before rendering.
void checkWritable(const std::filesystem::path& path);

// .exr: all layers and the metadata; float32, scanlines, ZIP. .hdr and .pfm: the colour. .png: the
// colour through `transform`, 8 bits, sRGB, and its alpha, by which the colour, associated in the
// layer, is divided first. Throws as checkWritable does, and
// RunError where writing fails.
void writeImage(const std::filesystem::path& path, const OutputImage& output,
                const DisplayTransform& transform = {});

// The colour alone.
void writeImage(const std::filesystem::path& path, const Image& color,
                const DisplayTransform& transform = {});

}  // namespace chromeball
