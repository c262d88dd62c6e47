#include "output_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "image/file.h"
#include "math/error.h"

namespace chromeball {

namespace fs = std::filesystem;

void checkOutputFile(const std::string& path, const std::vector<std::string_view>& extensions) {
  const fs::path file = path;
  std::string known;
  for (const std::string_view extension : extensions)
    known.append(known.empty() ? "" : " or ").append(extension);
  if (std::find(extensions.begin(), extensions.end(), file.extension()) == extensions.end())
    throwInput("{}: the name should end in {}", path, known);
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (!fs::is_directory(folder)) throwInput("{}: there is no folder {}", path, folder.string());
  if (fs::is_directory(file)) throwInput("{}: is a folder", path);
  if (access(folder.c_str(), W_OK) != 0)
    throwInput("{}: nothing can be written into {}: {}", path, folder.string(),
               std::strerror(errno));
}

void writeText(const std::string& path, std::string_view text) {
  writeFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace chromeball
