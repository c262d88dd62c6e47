#include "output_file.h"

#include <algorithm>
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
  checkReplaceable(file);
}

void writeText(const std::string& path, std::string_view text) {
  writeFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace chromeball
