// SPDX-License-Identifier: Apache-2.0
// Reading TOML with errors that say where and what would be right.
#pragma once

// Its assertions doubt what it then checks and reports well; without them, [[&]] is an error.
#define TOML_ASSERT(expression) static_assert(true)
#include <toml++/toml.h>

#include <cfloat>
#include <filesystem>
#include <functional>

#include "base/error.h"
#include "base/suggest.h"
#include "job/scene_file.h"

namespace chromeball {

template <class... Args>
[[noreturn]] void failAt(const std::string& location, fmt::format_string<Args...> format,
                         Args&&... args) {
  std::string what = fmt::format(format, std::forward<Args>(args)...);
  for (char& c : what)
    if (uint8_t(c) < ' ') c = '?';  // a quoted key may hold a line break; an error is one line
  throwInput("{}: {}", location, what);
}

// One value of the file with what an error about it has to say.
struct Entry {
  const std::string& file;
  std::string key;
  const toml::node* node;  // nullptr: the file does not give it

  explicit operator bool() const { return node; }
  std::string location() const { return fmt::format("{}:{}", file, node->source().begin.line); }

  [[noreturn]] void mustBe(std::string_view what) const {
    std::string found;
    if (node->is_integer())
      found = fmt::format("{}", node->as_integer()->get());
    else if (node->is_floating_point())
      found = fmt::format("{}", node->as_floating_point()->get());
    else if (node->is_string())
      found = fmt::format("\"{}\"", node->as_string()->get());
    else if (node->is_array())
      found = fmt::format("an array of {}", node->as_array()->size());
    else if (node->is_table())
      found = "a table";
    else if (node->is_boolean())
      found = "a boolean";
    else
      found = "a date or time";
    failAt(location(), "`{}` must be {}, not {}", key, what, found);
  }

  Entry element(size_t i) const { return {file, key, node->as_array()->get(i)}; }
  bool isArrayOf(size_t count) const {
    return node->is_array() && node->as_array()->size() == count;
  }

  std::string text() const {
    if (!node->is_string() || node->as_string()->get().empty()) mustBe("a string");
    return node->as_string()->get();
  }
  NamedSetting name() const { return {text(), location()}; }

  int64_t integer(int64_t minimum, int64_t maximum) const {
    const auto* number = node->as_integer();
    if (!number || number->get() < minimum || number->get() > maximum)
      mustBe(fmt::format("a whole number from {} to {}", minimum, maximum));
    return number->get();
  }

  // A finite number that a float can hold.
  double number(std::string_view what, const std::function<bool(double)>& valid) const {
    const auto number = node->is_number() ? node->value<double>() : std::nullopt;
    if (!number || !(std::abs(*number) <= FLT_MAX) || !valid(*number)) mustBe(what);
    return *number;
  }
  float number() const {
    return float(number("a finite number", [](double) { return true; }));
  }
  double positive() const {
    return number("a finite number above 0", [](double x) { return x > 0; });
  }

  vec3 vector() const {
    if (!isArrayOf(3)) mustBe("three numbers");
    return {element(0).number(), element(1).number(), element(2).number()};
  }
};

// A table that knows all its keys.
class Section {
 public:
  Section(const std::string& file, std::string name, const toml::table& table,
          const std::vector<std::string_view>& keys)
      : file_(file), name_(std::move(name)), table_(table) {
    for (const auto& [key, node] : table)
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
        failAt(fmt::format("{}:{}", file, key.source().begin.line), "unknown key `{}`{}; {}",
               key.str(), name_.empty() ? "" : " in [" + name_ + "]", didYouMean(key.str(), keys));
  }

  Entry operator[](std::string_view key) const {
    return {file_, std::string(key), table_.get(key)};
  }
  std::string location() const { return fmt::format("{}:{}", file_, table_.source().begin.line); }

  Section section(std::string_view key, const std::vector<std::string_view>& keys) const {
    static const toml::table kEmpty;
    const Entry entry = (*this)[key];
    if (entry && !entry.node->is_table()) entry.mustBe("a table");
    return Section(file_, std::string(key), entry ? *entry.node->as_table() : kEmpty, keys);
  }

 private:
  const std::string& file_;
  std::string name_;
  const toml::table& table_;
};

// A value, or an array of such values, one at a time.
template <class Read>
void forEach(const Entry& entry, const Read& read) {
  if (!entry) return;
  if (!entry.node->is_array()) return read(entry);
  for (size_t i = 0; i < entry.node->as_array()->size(); ++i) read(entry.element(i));
}

// The name of a file as the user would write it from where the program runs; existing() throws
// where there is no such file.
std::string resolved(const Entry& entry);
std::string existing(const Entry& entry);

// Throws InputError for what is no TOML.
toml::table parseToml(const std::string& path);

}  // namespace chromeball
