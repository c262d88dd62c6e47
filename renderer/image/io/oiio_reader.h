// SPDX-License-Identifier: Apache-2.0
// OpenImageIO's readers, each called by name.
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

// The reader for a file that begins with these bytes: "openexr", "png", "jpeg", "tiff", or nullptr.
const char* readerFor(std::span<const uint8_t> firstBytes);

// Both throw std::runtime_error with the reader's words where it cannot open the file.
std::unique_ptr<OIIO::ImageInput> openImage(const char* reader, const std::string& path,
                                            const OIIO::ImageSpec& config = {});

// Throws where an image of this size is not to be read.
using CheckSize = std::function<void(int width, int height, int channels)>;

// A PNG, JPEG or TIFF in memory, of which the library is given what is left without metadata
// (bare.h). Of a JPEG it takes memory for all texels as soon as it opens one, so `check` goes
// first; and for every format once it is open. `name` is for messages.
class MemoryInput {
 public:
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
