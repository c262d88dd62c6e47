// SPDX-License-Identifier: Apache-2.0
// OpenImageIO's readers, selected by name.
#pragma once

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace chromeball {

// The reader for a file that starts with these bytes: "openexr", "png", "jpeg", "tiff", or nullptr.
const char* readerFor(std::span<const uint8_t> firstBytes);

// Throws std::runtime_error with the reader's message if it cannot open the file.
std::unique_ptr<OIIO::ImageInput> openImage(const char* reader, const std::string& path,
                                            const OIIO::ImageSpec& config = {});

// Throws if an image of this size must not be read.
using CheckSize = std::function<void(int width, int height, int channels)>;

// Opens a PNG, JPEG or TIFF in memory. The library sees the file without its metadata
// (strip_metadata.h). `check` runs once the file is open; for a JPEG also before, because the
// library allocates all texels of a JPEG when it opens one.
class MemoryInput {
 public:
  // `name` is for messages. Throws std::runtime_error with the reader's message if it cannot open
  // the file, and whatever `check` throws.
  MemoryInput(const char* reader, std::span<const uint8_t> file, const std::string& name,
              const CheckSize& check, OIIO::ImageSpec config = {});
  MemoryInput(const MemoryInput&) = delete;
  MemoryInput& operator=(const MemoryInput&) = delete;

  OIIO::ImageInput& input() { return *input_; }

 private:
  std::vector<uint8_t> file_;
  OIIO::Filesystem::IOMemReader memory_;
  std::unique_ptr<OIIO::ImageInput> input_;
};

}  // namespace chromeball
