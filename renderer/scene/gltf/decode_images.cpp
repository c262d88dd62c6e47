// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/material_reader.h"

#include <algorithm>
#include <atomic>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "image/io/decode_image.h"
#include "image/io/texel_file.h"
#include "scene/texture.h"

namespace chromeball {
namespace {

// A level of so few texels stays in memory: the cache's record of it takes as much.
constexpr int kMinStoredTexels = 32 * 32;

bool isDecoded(const TexelGrid& grid) { return grid.width > 0; }

struct Source {
  const ImageToDecode* image;
  bool isRead = false;    // whether the texels are taken from the file
  size_t length = 0;      // of it, bytes
  double texelBytes = 0;  // of the image, by the header of its file
};

std::vector<Source> sourcesOf(const GltfFile& file, const std::vector<ImageToDecode>& images) {
  std::vector<Source> sources;
  for (const ImageToDecode& image : images) {
    if (isDecoded(*image.grid) && image.chains.empty()) continue;
    Source& source = sources.emplace_back();
    source.image = &image;
    source.isRead = !isDecoded(*image.grid) || image.grid->file;
    source.texelBytes = double(image.grid->byteCount());
    if (!source.isRead) continue;
    Bytes storage;  // freed at once: all files of a model may not fit into memory
    const std::span<const uint8_t> bytes = file.image(image.image, storage);
    source.length = bytes.size();
    source.texelBytes = double(decodedBytes(bytes));
  }
  return sources;
}

// Bytes of the texels to decode and of the mip levels to make.
double bytesOf(const std::vector<Source>& sources) {
  double bytes = 0;
  for (const Source& s : sources)
    bytes +=
        s.texelBytes * ((isDecoded(*s.image->grid) ? 0 : 1) + double(s.image->chains.size()) / 3);
  return bytes;
}

TexelGrid stored(TexelGrid grid, TexelFile* file) {
  if (!file || grid.width * grid.height <= kMinStoredTexels) return grid;
  TexelGrid inFile{grid.width, grid.height, {}, {}, file};
  inFile.fileImage = grid.texels8.empty() ? file->add(grid.width, grid.height, grid.texelsFloat)
                                          : file->add(grid.width, grid.height, grid.texels8);
  return inFile;
}

// Mip levels are built while the texels are in the processor's cache.
void decode(const Source& source, const GltfFile& file, TexelFile* texelFile) {
  TexelGrid& grid = *source.image->grid;
  TexelGrid decoded;
  if (source.isRead) {
    Bytes storage;
    DecodedImage d = decodeImage(file.image(source.image->image, storage),
                                 file.describeImage(source.image->image));
    decoded = {d.width, d.height, std::move(d.texels8), std::move(d.texelsFloat)};
  }
  const TexelGrid& from = source.isRead ? decoded : grid;
  for (const ChainToMake& wanted : source.image->chains) {
    std::vector<TexelGrid> levels = makeMipLevels(from, wanted.srgb, wanted.weightedByAlpha);
    for (TexelGrid& level : levels) level = stored(std::move(level), texelFile);
    *wanted.chain = std::make_shared<const std::vector<TexelGrid>>(std::move(levels));
  }
  if (!isDecoded(grid)) grid = stored(std::move(decoded), texelFile);
}

// Long files come first, so that no thread works on one alone at the end.
void decodeInParallel(std::vector<Source>& sources, const GltfFile& file) {
  std::sort(sources.begin(), sources.end(),
            [](const Source& a, const Source& b) { return a.length > b.length; });
  std::atomic<size_t> next = 0, done = 0;
  parallelFor(size_t(0), sources.size(), [&](size_t) {
    decode(sources[next++], file, nullptr);
    reportWork("textures", double(++done) / double(sources.size()));
  });
}

}  // namespace

void decodeImages(const GltfFile& file, const std::vector<ImageToDecode>& images,
                  TexelCache& cache) {
  std::vector<Source> sources = sourcesOf(file, images);
  const double bytes = bytesOf(sources);
  if (!cache.file && cache.used + bytes > cache.memory)
    cache.file = std::make_shared<TexelFile>(size_t(std::max(cache.memory - cache.used, 0.0)));
  if (!cache.file) {
    cache.used += bytes;
    if (cache.used > cache.limit)
      throw InputError(
          fmt::format("{}: its textures take {:.3g} GB of memory; the limit is {:.3g} GB",
                      file.files().front(), 1e-9 * cache.used, 1e-9 * cache.limit),
          Remedy{"memory", {}});
    return decodeInParallel(sources, file);
  }
  for (size_t i = 0; i < sources.size(); ++i) {
    decode(sources[i], file, cache.file.get());
    reportWork("textures", double(i + 1) / double(sources.size()));
  }
}

}  // namespace chromeball
