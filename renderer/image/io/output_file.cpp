// SPDX-License-Identifier: Apache-2.0
#include "image/io/output_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <map>

#include "base/error.h"
#include "base/file.h"
#include "image/io/cube_files.h"
#include "image/io/write_image.h"

namespace chromeball {

namespace fs = std::filesystem;

namespace {

// The same for all names of a file: its device and inode if it exists, else its canonical name.
// Empty if that cannot be found out.
std::string keyOf(const fs::path& file) {
  struct stat found;
  if (stat(file.c_str(), &found) == 0)
    return fmt::format("{}:{}", uint64_t(found.st_dev), uint64_t(found.st_ino));
  if (errno == ELOOP) return {};
  std::error_code error;  // a missing file's relative path stays so
  const fs::path canonical =
      fs::weakly_canonical(fs::absolute(replaceableFile(file), error), error);
  return error ? std::string() : canonical.string();
}

fs::path folderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

void checkOutputFile(const std::string& path, const std::vector<std::string_view>& extensions) {
  const fs::path file = path;
  if (std::find(extensions.begin(), extensions.end(), lowerExtension(file)) == extensions.end())
    throwInput("{}: the name must end in {}", path, fmt::join(extensions, " or "));
  checkReplaceable(file);
}

void checkDistinct(const std::vector<std::string>& outputs,
                   const std::vector<std::string>& inputs) {
  std::map<std::string, std::string> read, written;  // names by key
  for (const std::string& input : inputs) {
    if (!input.empty()) read.try_emplace(keyOf(input), input);
    for (const fs::path& face : cubeFilesIn(input)) read.try_emplace(keyOf(face), face.string());
  }
  for (const std::string& output : outputs) {
    const std::string key = output.empty() ? "" : keyOf(output);
    if (key.empty()) continue;
    if (const auto same = read.find(key); same != read.end())
      throwInput("{}: would overwrite the input {}; give the output another name", output,
                 same->second);
    if (const auto [same, isNew] = written.try_emplace(key, output); !isNew)
      throwInput("{}: would overwrite the other output {}; give one of them another name", output,
                 same->second);
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
