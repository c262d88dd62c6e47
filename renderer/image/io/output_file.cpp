// SPDX-License-Identifier: Apache-2.0
#include "image/io/output_file.h"

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "image/io/write_image.h"

namespace chromeball {

namespace fs = std::filesystem;

namespace {

// Compares existing files by device and inode, missing ones by their canonical names.
bool isSameFile(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const bool exists = fs::exists(a, error);
  if (exists != fs::exists(b, error)) return false;
  if (exists) return fs::equivalent(a, b, error);
  const auto canonical = [&](const fs::path& path) {  // a missing file's relative path stays so
    return fs::weakly_canonical(fs::absolute(replaceableFile(path), error), error);
  };
  const fs::path canonicalA = canonical(a);
  return !error && canonicalA == canonical(b) && !error;
}

fs::path folderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

void checkOutputFile(const std::string& path, const std::vector<std::string_view>& extensions) {
  const fs::path file = path;
  std::string known;
  for (const std::string_view extension : extensions)
    known.append(known.empty() ? "" : " or ").append(extension);
  if (std::find(extensions.begin(), extensions.end(), file.extension()) == extensions.end())
    throwInput("{}: the name must end in {}", path, known);
  checkReplaceable(file);
}

void checkDistinct(const std::vector<std::string>& outputs,
                   const std::vector<std::string>& inputs) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].empty()) continue;
    for (const std::string& input : inputs)
      if (!input.empty() && isSameFile(outputs[i], input))
        throwInput("{}: would overwrite the input {}; give the output another name", outputs[i],
                   input);
    for (size_t j = 0; j < i; ++j)
      if (!outputs[j].empty() && isSameFile(outputs[i], outputs[j]))
        throwInput("{}: would overwrite the other output {}; give one of them another name",
                   outputs[i], outputs[j]);
  }
}

void checkSceneOutput(const std::string& path) {
  const fs::path folder = folderOf(path);
  if (fs::exists(folder) || !fs::is_directory(folderOf(folder))) return checkWritable(path);
  checkImageName(path);
  checkReplaceable(folder);
}

void makeFolder(const std::string& path) {
  std::error_code error;
  fs::create_directory(folderOf(path), error);
  if (error) throwRun("{}: cannot be created: {}", folderOf(path).string(), error.message());
}

void writeText(const std::string& path, std::string_view text) {
  writeFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace chromeball
