// SPDX-License-Identifier: Apache-2.0
// An open OpenEXR file, shared by the readers of whole images and of bands of rows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "image/io/read_image.h"

namespace chromeball {

// Reads the part of a file that has its colour (color_channels.h), else the first; the largest of
// its levels. Functions throw InputError.
class ExrInput {
 public:
  enum class Numbers { Half, Float, Integer, Mixed };  // of the channels

  // `maxNumbers`: the most that the image may have.
  ExrInput(const std::filesystem::path& path, uint64_t maxNumbers);
  ExrInput(ExrInput&&) noexcept;
  ~ExrInput();

  int width() const { return width_; }  // of the data window
  int height() const { return height_; }
  // All but the texels. If several layers or parts have colour, a message names the chosen one.
  const ImageFile& contents() const { return contents_; }
  const std::vector<std::string>& channels() const { return contents_.channels; }
  double pixelAspectRatio() const { return pixelAspectRatio_; }  // width / height
  Numbers numbers() const { return numbers_; }
  bool isTiled() const { return isTiled_; }
  int rowsOfBlock() const { return rowsOfBlock_; }  // rows that are compressed together

  // All channels, interleaved, of `count` rows from `top` on. Integers become fractions of the
  // largest one.
  void read(int top, int count, float* texels);

 private:
  class Part;
  void readHeader();

  std::filesystem::path path_;
  int rowsOfBlock_ = 1, width_ = 0, height_ = 0;
  ImageFile contents_;
  double pixelAspectRatio_ = 1;
  Numbers numbers_ = Numbers::Half;
  bool isTiled_ = false;
  std::unique_ptr<Part> part_;
};

}  // namespace chromeball
