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

class ExrInput;

// A file of scanlines with channels of one type, float32 or 16 bits. Functions throw InputError
// ("FILE: reason").
class ExrRowsReader {
 public:
  // `maxNumbers`: that the image may have.
  ExrRowsReader(const std::filesystem::path& path, uint64_t maxNumbers);
  ExrRowsReader(ExrRowsReader&&) noexcept;
  ~ExrRowsReader();

  int width() const;
  int height() const;
  const std::vector<std::string>& channels() const;
  const Metadata& metadata() const;
  const std::optional<Placement>& placement() const;  // in the display window, if not that
  const std::optional<Chromaticities>& primaries() const;

  // All channels of `count` rows from `top` on.
  Image read(int top, int count);

  // What reading takes besides that image, at most. Bytes.
  double bufferBytes() const;

 private:
  std::unique_ptr<ExrInput> input_;
};

}  // namespace chromeball
