// SPDX-License-Identifier: Apache-2.0
// Writes binary glTF 2.0: a JSON chunk and one buffer.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/file.h"

namespace chromeball::demo {

using nlohmann::json;

class GlbWriter {
 public:
  // Appends the items as a buffer view of their own; returns its index.
  template <class T>
  int view(const std::vector<T>& items) {
    const size_t bytes = items.size() * sizeof(T), offset = bin_.size();
    bin_.resize((offset + bytes + 3) / 4 * 4);
    std::memcpy(&bin_[offset], items.data(), bytes);
    root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
    return int(root["bufferViews"].size()) - 1;
  }
  template <class T>
  int accessor(const std::vector<T>& items, int componentType, const char* type, size_t count) {
    root["accessors"].push_back({{"bufferView", view(items)},
                                 {"componentType", componentType},
                                 {"count", count},
                                 {"type", type}});
    return int(root["accessors"].size()) - 1;
  }
  void write(const std::string& path) {
    root["buffers"] = {{{"byteLength", bin_.size()}}};
    std::string text = root.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<uint8_t> file;
    const auto word = [&](size_t x) {
      for (int shift = 0; shift < 32; shift += 8) file.push_back(uint8_t(x >> shift));
    };
    word(0x46546C67), word(2), word(12 + 8 + text.size() + 8 + bin_.size());
    word(text.size()), word(0x4E4F534A);
    file.insert(file.end(), text.begin(), text.end());
    word(bin_.size()), word(0x004E4942);
    file.insert(file.end(), bin_.begin(), bin_.end());
    writeFile(path, file);
  }

  json root = {{"asset", {{"version", "2.0"}, {"generator", "chromeball make_demo"}}},
               {"scene", 0}};

 private:
  std::vector<uint8_t> bin_;
};

}  // namespace chromeball::demo
