// SPDX-License-Identifier: Apache-2.0
// The formats that only OpenImageIO reads (TIFF). It loads 250 libraries, so it is behind a module,
// libchromeball_imageio.so, which is loaded for the first file that needs it. The module and the
// library share only this header.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace chromeball {

struct ModuleImageHeader {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  int integerBits = 0;             // per channel, 8 or 16; 0: floats
  int alphaChannel = -1;           // -1: none
  bool unassociatedAlpha = false;  // the colour is to be multiplied by alpha
  uint64_t bytes = 0;              // of the texels, as the file has them
};

// An open file. Functions throw std::runtime_error with the reason.
class ModuleImage {
 public:
  virtual ~ModuleImage() = default;
  virtual const ModuleImageHeader& header() const = 0;
  // All texels, channels interleaved; integers are fractions of the largest one.
  virtual void read(float* texels) = 0;
};

// The module's functions, which it exports by these names. `format` is OpenImageIO's name of it;
// the tests compare our own readers with others. The file must outlive the image; `name` is for
// messages.
using ModuleVersion = const char*();
using ModuleOpen = ModuleImage*(const char* format, const uint8_t* file, size_t bytes,
                                const char* name);
inline constexpr const char* kModuleVersion = "chromeballImageioVersion";
inline constexpr const char* kModuleOpen = "chromeballImageioOpen";
inline constexpr const char* kModuleLibrary = "chromeballImageioLibrary";  // OpenImageIO's version

// Loads the module if it is not yet loaded. Throws InputError if there is no module beside the
// library or the command, or if the image exceeds the limits (size_limits.h).
std::unique_ptr<ModuleImage> openModuleImage(const char* format, std::span<const uint8_t> file,
                                             const std::filesystem::path& path);

// Whether the module can be loaded, which this does.
struct ModuleState {
  std::string version;  // of OpenImageIO
  std::string problem;  // why there is none; empty: there is one
};
ModuleState imageioModuleState();

}  // namespace chromeball
