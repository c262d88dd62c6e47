// SPDX-License-Identifier: Apache-2.0
// Reads OpenEXR files by bands of rows, so that an image larger than the memory can be read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "image/image.h"
#include "image/io/read_image.h"

namespace chromeball {

// A file of scanlines with channels of one type, float32 or 16 bits. Functions throw InputError
// ("FILE: reason").
class ExrRowsReader {
 public:
  // `maxNumbers`: that the image may have.
  ExrRowsReader(const std::filesystem::path& path, uint64_t maxNumbers);
  ExrRowsReader(ExrRowsReader&&) noexcept;
  ~ExrRowsReader();

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<std::string>& channels() const { return channels_; }
  const Metadata& metadata() const { return metadata_; }

  // All channels of `count` rows from `top` on.
  Image read(int top, int count);

  // What reading takes besides that image, at most. Bytes.
  double bufferBytes() const;

 private:
  int rowsAtOnce() const;

  class Input;
  std::filesystem::path path_;
  std::unique_ptr<Input> input_;
  int width_ = 0, height_ = 0, rowsOfBlock_ = 1;
  std::vector<std::string> channels_;
  Metadata metadata_;
};

}  // namespace chromeball
