// SPDX-License-Identifier: Apache-2.0
#include "image/io/imageio_module.h"

#include <dlfcn.h>
#include <link.h>

#include <string_view>
#include <system_error>

#include "base/error.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModuleName = "libchromeball_imageio.so";

// The folder of the shared library or of the executable that this code is in. (A link map has no
// name for the executable.)
fs::path ownFolder() {
  Dl_info info{};
  link_map* map = nullptr;
  const bool found = dladdr1(reinterpret_cast<const void*>(&ownFolder), &info,
                             reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP);
  const bool isLibrary = found && map && map->l_name && map->l_name[0];
  std::error_code error;
  const fs::path self = fs::canonical(isLibrary ? map->l_name : "/proc/self/exe", error);
  return error ? fs::path() : self.parent_path();
}

struct ImageioModule {
  ModuleOpen* open = nullptr;
  ModuleVersion* library = nullptr;
  std::string problem;  // why there is none
};

ImageioModule loadImageioModule() {
  const fs::path folder = ownFolder();
  std::string problem;
  // Looks beside this code; where the installed library is, seen from the installed command; and in
  // the system's search path.
  for (const fs::path& path : {folder / kModuleName, folder / CHROMEBALL_BIN_TO_LIB / kModuleName,
                               fs::path(kModuleName)}) {
    if (path.has_parent_path() && !fs::exists(path)) continue;
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) {
      problem = dlerror();
      if (path.has_parent_path()) break;
      continue;
    }
    const auto version = reinterpret_cast<ModuleVersion*>(dlsym(library, kModuleVersion));
    const auto open = reinterpret_cast<ModuleOpen*>(dlsym(library, kModuleOpen));
    const auto of = reinterpret_cast<ModuleVersion*>(dlsym(library, kModuleLibrary));
    if (version && open && of && std::string_view(version()) == CHROMEBALL_VERSION)
      return {open, of, ""};
    return {.problem = path.string() + " is of another version"};
  }
  return {.problem = problem};
}

const ImageioModule& imageioModule() {
  static const ImageioModule module = loadImageioModule();
  return module;
}

}  // namespace

std::unique_ptr<ModuleImage> openModuleImage(const char* format, std::span<const uint8_t> file,
                                             const fs::path& path) {
  const ImageioModule& module = imageioModule();
  if (!module.open)
    throwInput(
        "{}: is a {} file, which needs the module {} beside the command or the library, as the "
        "package chromeball-tiff installs it ({}); convert the image to .exr or .png",
        path.string(), format, kModuleName, module.problem);
  std::unique_ptr<ModuleImage> image(module.open(format, file.data(), file.size(), path.c_str()));
  const ModuleImageHeader& header = image->header();
  checkImageSize(path, header.width, header.height, int64_t(header.channels.size()));
  // For TIFF see pictureDirectory().
  checkFileLength(path, header.width, header.height, header.bytes, file.size(), kMaxUnknownRatio);
  return image;
}

ModuleState imageioModuleState() {
  const ImageioModule& module = imageioModule();
  return {module.library ? module.library() : "", module.problem};
}

}  // namespace chromeball
