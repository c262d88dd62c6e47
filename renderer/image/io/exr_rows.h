// SPDX-License-Identifier: Apache-2.0
// Writes OpenEXR files by bands of rows, so that an image larger than the memory can be written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/archive.h"
#include "image/image.h"
#include "image/io/exr_input.h"
#include "image/io/write_image.h"

namespace chromeball {

struct ExrLayout {
  int width, height;
  std::vector<std::string> channels;
  Metadata metadata;
  std::optional<Placement> placement = {};
  // 16 bits: exact to 0.05% from 6e-5 to 65504, to 3e-8 below, and clipped above (clipped()); else
  // float32.
  bool halves = false;
  // ZIPS, else ZIP, which compresses 16 rows together. With hundreds of channels these gain nothing
  // from each other, and take 16 times the memory.
  bool separateRows = false;
};

// A file of scanlines. Atomic: it appears with commit(); without that, nothing remains.
class ExrRowsWriter {
 public:
  // Throws RunError, as all functions do.
  ExrRowsWriter(const std::filesystem::path& path, const ExrLayout& layout);
  ~ExrRowsWriter();

  // The next rows, from the top down: images of one size, which have the layout's channels in turn.
  void write(std::span<const Image* const> images);

  uint64_t clipped() const;  // finite numbers beyond the range of halves so far

  // To be called after the last row. `state`: further contents of the file (exr_state.h); may be
  // empty.
  void commit(const std::function<void(Archive&)>& state = {});

  // The most memory that writing takes besides the images, in bytes.
  static double bufferBytes(int width, size_t channels);  // of separate rows

 private:
  class Output;
  std::unique_ptr<Output> output_;
};

// OpenEXR files with layers, attributes, and state that this program reads again (exr_state.h).

// Writes float32 scanlines with ZIP compression, and output.state if it is set. Atomic. Throws
// RunError.
void writeExr(const std::filesystem::path& path, const OutputImage& output);

// Reads OpenEXR files by bands of rows, so that an image larger than the memory can be read.

// A file of scanlines with channels of one type, float32 or 16 bits. Functions throw InputError
// ("FILE: reason").
class ExrRowsReader : public ExrInput {
 public:
  // `maxNumbers`: the most that the image may have.
  ExrRowsReader(const std::filesystem::path& path, uint64_t maxNumbers);

  // All channels of `count` rows from `top` on.
  Image read(int top, int count);

  // The most memory that reading takes besides that image, in bytes.
  double bufferBytes() const;
};

}  // namespace chromeball
