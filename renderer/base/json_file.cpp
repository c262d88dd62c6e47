// SPDX-License-Identifier: Apache-2.0
#include "base/json_file.h"

#include <algorithm>

#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "base/json_text.h"

namespace chromeball {

using nlohmann::json;

json readJsonFile(const std::filesystem::path& path, size_t maxMegabytes, std::string_view kind) {
  std::error_code unreadable;
  const auto size = std::filesystem::file_size(path, unreadable);
  if (!unreadable && size > maxMegabytes << 20)
    throwInput("{}: has {} MB; {} have at most {}", path.string(), size >> 20, kind, maxMegabytes);
  const std::vector<uint8_t> bytes = readFile(path);
  try {
    return parseJson(bytes);
  } catch (const json::parse_error& error) {
    const auto end = bytes.begin() + ptrdiff_t(std::min(error.byte, bytes.size()));
    throwInput("{}:{}: is not valid JSON here", path.string(),
               1 + std::count(bytes.begin(), end, '\n'));
  } catch (const json::out_of_range&) {  // which the parser throws for nothing else
    throwInput("{}: has a number beyond 1.8e308, the range of a double", path.string());
  }
}

}  // namespace chromeball
