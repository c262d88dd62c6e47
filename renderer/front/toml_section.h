// SPDX-License-Identifier: Apache-2.0
// Reads TOML. Error messages begin with FILE:LINE and describe valid input.
#pragma once

#include <string>
#include <string_view>

// parseToml() reports invalid keys such as [[&]] itself; the library's assertions would abort.
#define TOML_ASSERT(expression) static_assert(true)
#include <toml++/toml.h>

#include <filesystem>

#include "base/error.h"
#include "base/text.h"
#include "front/settings.h"
#include "math/vec.h"

namespace chromeball {

template <class... Args>
[[noreturn]] void failAt(const std::string& location, fmt::format_string<Args...> format,
                         Args&&... args) {
  std::string what = fmt::format(format, std::forward<Args>(args)...);
  for (char& c : what)
    if (uint8_t(c) < ' ') c = '?';  // a quoted key may hold a line break; an error is one line
  throwInput("{}: {}", location, what);
}

// "FILE:LINE"; without a line for values from memory (scene_values.h).
template <class Place>
std::string locationIn(const std::string& file, const Place& place) {
  const auto line = place.source().begin.line;
  return line > 0 ? fmt::format("{}:{}", file, line) : file;
}

// One value of the file. Its functions throw InputError for a value of another type, or one outside
// the range of its row in the table of settings.
struct Entry {
  const std::string& file;
  std::string key;
  const toml::node* node;            // nullptr: the key is missing
  const Setting* setting = nullptr;  // nullptr: a table, or an array of tables

  explicit operator bool() const { return node; }
  std::string location() const { return locationIn(file, *node); }

  [[noreturn]] void mustBe(std::string_view what) const;

  Entry element(size_t i) const { return {file, key, node->as_array()->get(i), setting}; }
  bool isArray() const { return node->is_array(); }
  bool isArrayOf(size_t count) const { return isArray() && node->as_array()->size() == count; }

  std::string text() const;    // not empty, without U+0000
  std::string choice() const;  // one of the setting's choices
  bool flag() const;
  uint64_t integer() const;
  double number() const;  // finite as a float, in the range
  double number(const Range& narrower) const;
  std::vector<double> numbers() const;  // one such number, or an array of as many as allowed
  vec3 vector() const;                  // three such numbers
  vec3 oneOrThree() const;              // one for all of them, or three
  glm::dvec3 point() const;             // likewise, not rounded: a position in the world, metres

  // The value of a setting that is not a Compound.
  SettingValue value() const;
};

// A table of the file. Its constructor throws InputError for a key that the table of settings does
// not have.
class Section {
 public:
  // `section`: its name in the table of settings.
  Section(const std::string& file, std::string section, const toml::table& table);
  // The whole file: `keys` are the names of its tables.
  Section(const std::string& file, const toml::table& table,
          const std::vector<std::string_view>& keys);

  Entry operator[](std::string_view key) const {
    return {file_, std::string(key), table_.get(key), findSetting(name_, key)};
  }
  Entry required(std::string_view key) const;
  std::string location() const { return locationIn(file_, table_); }

  // The heading as written in the file: [probe], [[light]].
  std::string heading() const;

  // A table within this one; an empty one if it is missing.
  Section section(std::string_view key) const;

  // Throws InputError for a key that is not in `keys`; `owner` ("a spot light") has only these.
  void allowOnly(const std::vector<std::string_view>& keys, std::string_view owner) const;

  // Puts the values of all keys but the Compounds into `settings`.
  void read(Settings& settings) const;

 private:
  void checkKeys(const std::vector<std::string_view>& known) const;

  const std::string& file_;
  std::string name_;
  const toml::table& table_;
};

// A value, or each of an array of such values.
template <class Read>
void forEach(const Entry& entry, const Read& read) {
  if (!entry) return;
  if (!entry.isArray()) return read(entry);
  for (size_t i = 0; i < entry.node->as_array()->size(); ++i) read(entry.element(i));
}

// A file name of a TOML file as a path from the working directory; existingFile() throws
// InputError if there is no such file.
std::string resolvedPath(const Entry& entry);
std::string existingFile(const Entry& entry, std::string_view relativeTo = "the scene file");

// Throws InputError for a file that is not valid TOML.
toml::table parseToml(const std::string& path);

}  // namespace chromeball
