// SPDX-License-Identifier: Apache-2.0
// Where the values of a description are from, for messages.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace chromeball {

// "sources[2]": the name of an entry of an array of the description.
inline std::string elementName(std::string_view array, size_t index) {
  return std::string(array) + "[" + std::to_string(index) + "]";
}

// Where values come from, such as "scene.toml:12" or "--samples". They are found by their names in
// the table of settings ("render.samples") or by their places in RenderDescription ("camera.lens",
// "sources[2]"). The origin of a value from memory is its name.
class Origins {
 public:
  void set(const std::string& name, const std::string& location) { locations_[name] = location; }

  // Whether someone has given the value; else it is a default, or a program's.
  bool has(std::string_view name) const { return locations_.contains(name); }
  std::string of(std::string_view name) const {
    const auto found = locations_.find(name);
    return found == locations_.end() || found->second.empty() ? std::string(name) : found->second;
  }

 private:
  std::map<std::string, std::string, std::less<>> locations_;
};

}  // namespace chromeball
