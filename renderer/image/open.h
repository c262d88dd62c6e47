// OpenImageIO's readers, each called by name.
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <span>
#include <string>

namespace chromeball {

// The reader for a file that begins with these bytes: "openexr", "png", "jpeg", "tiff", or nullptr.
const char* readerFor(std::span<const uint8_t> firstBytes);

// Throws std::runtime_error with the reader's words where it cannot open the file.
std::unique_ptr<OIIO::ImageInput> openImage(const char* reader, const std::string& path,
                                            const OIIO::ImageSpec& config = {});

}  // namespace chromeball
