// SPDX-License-Identifier: Apache-2.0
#include "front/toml_section.h"

#include <algorithm>
#include <cfloat>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "front/settings.h"
#include "front/synonyms.h"

namespace chromeball {
namespace {

constexpr size_t kMaxFileBytes = size_t(4) << 20;

std::string describe(const toml::node& node) {
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{:#}", number->get());
  if (const auto* text = node.as_string()) return fmt::format("\"{}\"", printableName(text->get()));
  if (const auto* array = node.as_array()) return fmt::format("an array of {}", array->size());
  if (node.is_table()) return "a table";
  if (node.is_boolean()) return "a boolean";
  return "a date or time";
}

}  // namespace

void Entry::mustBe(std::string_view what) const {
  failAt(location(), "`{}` must be {}, not {}", key, what, describe(*node));
}

std::string Entry::text() const {
  if (!node->is_string() || node->as_string()->get().empty()) mustBe("a string");
  const std::string& text = node->as_string()->get();
  if (text.find('\0') != std::string::npos)  // it would end a file name
    mustBe("a string without U+0000");
  return text;
}

std::string Entry::choice() const {
  const std::string name = text();
  checkSetting(*setting,
               setting->type == SettingType::Choices ? SettingValue(std::vector<std::string>{name})
                                                     : SettingValue(name),
               fmt::format("{}: `{}`", location(), key));
  return name;
}

bool Entry::flag() const {
  if (!node->is_boolean()) mustBe(expected(*setting));
  return node->as_boolean()->get();
}

uint64_t Entry::integer() const {
  const auto* number = node->as_integer();
  if (!number || number->get() < 0 || !setting->range.contains(double(number->get()))) {
    Setting whole = *setting;
    whole.type = SettingType::Integer;
    mustBe(expected(whole));
  }
  return uint64_t(number->get());
}

double Entry::number() const { return number(setting->range); }

double Entry::number(const Range& range) const {
  const auto number = node->is_number() ? node->value<double>() : std::nullopt;
  if (!number || !(std::abs(*number) <= FLT_MAX) || !range.contains(*number))
    mustBe(expectedNumber(*setting, range));
  return *number;
}

std::vector<double> Entry::numbers() const {
  if (const auto* name = node->as_string(); name && !setting->named.empty()) {
    if (const auto* named = numbersCalled(*setting, name->get())) return *named;
    mustBe(expected(*setting));
  }
  std::vector<double> all;
  forEach(*this, [&](const Entry& e) { all.push_back(e.number()); });
  if (std::ranges::count(setting->counts, all.size()) == 0) mustBe(expected(*setting));
  return all;
}

vec3 Entry::vector() const { return vec3(point()); }

vec3 Entry::oneOrThree() const { return isArray() ? vector() : vec3(float(number())); }

glm::dvec3 Entry::point() const {
  if (!isArrayOf(3)) mustBe("three numbers");
  return {element(0).number(), element(1).number(), element(2).number()};
}

SettingValue Entry::value() const {
  switch (setting->type) {
    case SettingType::Flag:
      return flag();
    case SettingType::Integer:
      return integer();
    case SettingType::Number:
      return number();
    case SettingType::Factor:
      return node->is_string() && text() == "off" ? 0.0 : number();
    case SettingType::NumberOrAuto:
      if (!node->is_number() && !node->is_string()) mustBe(expected(*setting));
      return node->is_number() ? toText(number()) : choice();
    case SettingType::Numbers:
      return numbers();
    case SettingType::Choice:
      return choice();
    case SettingType::Choices: {
      std::vector<std::string> names;
      forEach(*this, [&](const Entry& e) { names.push_back(e.choice()); });
      return names;
    }
    case SettingType::Name:
      return text();
    case SettingType::File:
      return existingFile(*this);
    case SettingType::Source: {
      std::error_code ignored;
      const std::string path = resolvedPath(*this);
      return std::filesystem::is_directory(path, ignored) ? path : existingFile(*this);
    }
    case SettingType::Files: {
      std::vector<std::string> paths;
      forEach(*this, [&](const Entry& e) { paths.push_back(resolvedPath(e)); });
      return paths;
    }
    case SettingType::Size:
      if (!isArrayOf(2)) mustBe(expected(*setting));
      return ImageSize{int(element(0).integer()), int(element(1).integer())};
    case SettingType::Compound:
      break;
  }
  throw std::logic_error("a compound setting has its own reader: " + setting->name());
}

Section::Section(const std::string& file, std::string section, const toml::table& table)
    : file_(file), name_(std::move(section)), table_(table) {
  checkKeys(keysOf(name_));
}

Section::Section(const std::string& file, const toml::table& table,
                 const std::vector<std::string_view>& keys)
    : file_(file), table_(table) {
  checkKeys(keys);
}

namespace {

std::string headingOf(std::string_view name) {
  for (const SettingSection& section : settingSections())
    if (section.name == name && section.heading.starts_with('['))
      return std::string(section.heading);
  return fmt::format("[[{}]]", name);  // [[model]]
}

// The key of this section, or table of the file, that differs little; else that of another section
// which others call so; empty if there is neither.
std::string hintOnWord(std::string_view key, bool isTable, std::string_view section,
                       const std::vector<std::string_view>& known) {
  if (isTable && section.empty())  // [[lights]], not `lights` in [lighting]
    if (const auto near = nearestName(key, known); !near.empty())
      return fmt::format("did you mean {}?", headingOf(near));
  if (const auto same = sameName(key, known); !same.empty())
    return fmt::format("did you mean `{}`?", same);
  const Setting* meant = settingCalled(key);
  if (!meant) return "";
  if (meant->key.empty()) return fmt::format("did you mean the option --{}?", meant->option);
  if (isTable) return fmt::format("did you mean {}?", headingOf(meant->section));
  if (std::ranges::count(known, meant->option) > 0)  // `ground`, which [composite] has too
    return fmt::format("did you mean `{}`?", meant->option);
  if (meant->section == section) return fmt::format("did you mean `{}`?", meant->key);
  return fmt::format("did you mean `{}` in {}?", meant->key, headingOf(meant->section));
}

// What the unknown key of a section may mean: one of this section, or of another.
std::string hintOn(std::string_view key, bool isTable, std::string_view section,
                   const std::vector<std::string_view>& known) {
  const bool isTop = section.empty() && std::ranges::count(known, "render") > 0;
  if (!isTop && (section.empty() || headingOf(section).starts_with("[["))) {
    const std::string hint = hintOnListKey(section, key);  // words have meanings of their own there
    return hint.empty() ? didYouMean(key, known) : hint;
  }
  if (const auto hint = hintOnWord(key, isTable, section, known); !hint.empty()) return hint;
  if (const auto place = placeOf(key); !place.empty()) return std::string(place);
  const auto& table = settingTable();
  const auto same = std::ranges::find(table, key, &Setting::key);
  if (same == table.end()) return didYouMean(key, known);
  return fmt::format("did you mean `{}` in {}?", key, headingOf(same->section));
}

}  // namespace

void Section::checkKeys(const std::vector<std::string_view>& known) const {
  for (const auto& [key, node] : table_)
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      failAt(locationIn(file_, key), "unknown key `{}`{}; {}", printableName(key.str()),
             name_.empty() ? "" : " in " + heading(),
             hintOn(key.str(), node.is_table() || node.is_array_of_tables(), name_, known));
}

Entry Section::required(std::string_view key) const {
  const Entry entry = (*this)[key];
  if (!entry)
    failAt(location(), "{} has no `{}`{}", heading(), key,
           entry.setting->choices.empty() ? "" : ": " + expected(*entry.setting));
  return entry;
}

std::string Section::heading() const { return headingOf(name_); }

Section Section::section(std::string_view key) const {
  static const toml::table kEmpty;
  const Entry entry = (*this)[key];
  if (entry && !entry.node->is_table()) entry.mustBe("a table");
  return Section(file_, std::string(key), entry ? *entry.node->as_table() : kEmpty);
}

void Section::allowOnly(const std::vector<std::string_view>& keys, std::string_view owner) const {
  for (const auto& [key, node] : table_)
    if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
      failAt(locationIn(file_, key), "{} has no `{}`; it has {}", owner, printableName(key.str()),
             fmt::join(keys, ", "));
}

void Section::read(Settings& settings) const {
  for (const Setting& setting : settingTable())
    if (setting.section == name_ && setting.type != SettingType::Compound)
      if (const Entry entry = (*this)[setting.key])
        settings.set(setting.name(), entry.value(), entry.location());
}

// Without "x/.." where that leads to the same folder: behind a link it leads elsewhere.
std::string resolvedPath(const Entry& entry) {
  namespace fs = std::filesystem;
  const fs::path whole = fs::path(entry.file).parent_path() / entry.text();
  const fs::path normal = whole.lexically_normal();
  const auto folderOf = [](const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
  };
  std::error_code none;
  const bool isSame = fs::equivalent(folderOf(whole), folderOf(normal), none);
  return (isSame || !fs::exists(folderOf(whole), none) ? normal : whole).string();
}

std::string existingFile(const Entry& entry, std::string_view relativeTo) {
  const std::string path = resolvedPath(entry);
  try {
    checkReadable(path);
  } catch (const InputError& error) {
    failAt(entry.location(), "`{}`: {} (paths are relative to {})", entry.key, error.what(),
           entry.node->source().begin.line > 0 ? relativeTo : "the working folder");
  }
  return path;
}

namespace {

// The position after the string or comment that begins at `begin`.
size_t endOfToken(std::string_view toml, size_t begin) {
  const char quote = toml[begin];
  if (quote == '#') return std::min(toml.find('\n', begin), toml.size());
  const std::string triple(3, quote);
  const bool isLong = toml.substr(begin).starts_with(triple);
  for (size_t at = begin + (isLong ? 3 : 1); at < toml.size(); ++at) {
    if (quote == '"' && toml[at] == '\\')
      ++at;
    else if (isLong ? toml.substr(at).starts_with(triple) : toml[at] == quote || toml[at] == '\n')
      return at + (isLong ? 3 : 1);
  }
  return toml.size();
}

// Bounds the nesting of dotted keys before TOML is parsed: toml++ bounds the nesting of values
// only, and walks the tables that keys make recursively. Throws InputError for a key of more than
// 16 parts (`a.b.c` has 3), as a header or anywhere else. Text that is not valid TOML passes, or
// fails with a line.
void checkKeyDepth(std::string_view toml, const std::string& path) {
  constexpr size_t kMostParts = 16;
  size_t dots = 0;
  for (size_t at = 0; at < toml.size();) {
    const char c = toml[at];
    if (c == '"' || c == '\'' || c == '#') {
      at = endOfToken(toml, at);
      continue;
    }
    if (c == '.') ++dots;
    if (std::string_view("\n,=[]{}").find(c) != std::string_view::npos) dots = 0;
    if (dots >= kMostParts)
      throwInput("{}:{}: a key has more than {} parts", path,
                 1 + std::count(toml.begin(), toml.begin() + ptrdiff_t(at), '\n'), kMostParts);
    ++at;
  }
}

}  // namespace

toml::table parseToml(const std::string& path) {
  checkReadable(path);
  if (const auto bytes = std::filesystem::file_size(path); bytes > kMaxFileBytes)
    throwInput("{}: {} bytes; a scene file has at most {}", path, bytes, kMaxFileBytes);
  const std::vector<uint8_t> bytes = readFile(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  checkKeyDepth(text, path);
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    failAt(fmt::format("{}:{}", path, error.source().begin.line), "not valid TOML: {}",
           error.description());
  }
}

}  // namespace chromeball
