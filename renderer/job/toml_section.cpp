// SPDX-License-Identifier: Apache-2.0
#include "job/toml_section.h"

#include "base/file.h"

namespace chromeball {
namespace {

constexpr size_t kMaxFileBytes = size_t(4) << 20;

}  // namespace

std::string resolved(const Entry& entry) {
  const auto folder = std::filesystem::path(entry.file).parent_path();
  return (folder / entry.text()).lexically_normal().string();
}

std::string existing(const Entry& entry) {
  const std::string path = resolved(entry);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    failAt(entry.location(), "`{}`: no such file: {} (paths are relative to the scene file)",
           entry.key, path);
  return path;
}

toml::table parseToml(const std::string& path) {
  checkReadable(path);
  if (const auto bytes = std::filesystem::file_size(path); bytes > kMaxFileBytes)
    throwInput("{}: {} bytes; a scene file has at most {}", path, bytes, kMaxFileBytes);
  const std::vector<uint8_t> bytes = readFile(path);
  try {
    return toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                       path);
  } catch (const toml::parse_error& error) {
    failAt(fmt::format("{}:{}", path, error.source().begin.line), "not valid TOML: {}",
           error.description());
  }
}

}  // namespace chromeball
