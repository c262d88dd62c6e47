// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/observations.h"

#include <algorithm>
#include <map>
#include <span>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"

namespace chromeball {
namespace {

using Fields = std::vector<std::string>;

struct Row {
  Fields fields;
  std::string location;
};

// Without spaces and quotation marks around it; messages quote it, so that other control characters
// become question marks.
std::string cleaned(std::string_view field) {
  const auto isOuter = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!field.empty() && isOuter(field.front())) field.remove_prefix(1);
  while (!field.empty() && isOuter(field.back())) field.remove_suffix(1);
  std::string text(field);
  for (char& c : text)
    if (uint8_t(c) < ' ') c = '?';
  return text;
}

Fields split(std::string_view line) {
  Fields fields;
  for (size_t begin = 0; begin <= line.size();) {
    const size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(cleaned(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

std::optional<double> numberIn(const std::string& text) {
  double number = 0;
  return toNumber(text, number) ? std::optional(number) : std::nullopt;
}

// The rows that have values. `columns`: their names; all but the first are numbers, and those from
// `required` on may be missing.
std::vector<Row> readRows(const std::filesystem::path& path, const Fields& columns,
                          size_t required) {
  constexpr size_t kMaxBytes = 1 << 20, kMaxRows = 1000;
  checkReadable(path);
  if (std::filesystem::file_size(path) > kMaxBytes)
    throwInput("{}: is too long for a list of at most {} rows", path.string(), kMaxRows);
  const std::vector<uint8_t> bytes = readFile(path);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark of UTF-8

  std::vector<Row> rows;
  bool isFirst = true;
  for (size_t begin = 0, number = 1; begin < text.size(); ++number) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    begin = end + 1;
    const std::string start = cleaned(line);
    if (start.empty() || start.starts_with('#')) continue;
    Row row{split(line), fmt::format("{}:{}", path.string(), number)};
    const std::span<const std::string> values = std::span(row.fields).subspan(1);
    const bool isNames = isFirst && std::ranges::none_of(values, [](const auto& f) {
                           return numberIn(f).has_value();
                         });
    isFirst = false;
    if (row.fields.size() < required || row.fields.size() > columns.size() ||
        (isNames && !std::equal(row.fields.begin(), row.fields.end(), columns.begin())))
      throwInput("{}: has the columns `{}`; they should be {}", row.location,
                 fmt::join(row.fields, ","), fmt::join(columns, ","));
    if (!isNames) rows.push_back(std::move(row));
    if (rows.size() > kMaxRows) throwInput("{}: has more than {} rows", path.string(), kMaxRows);
  }
  return rows;
}

double finiteNumber(const Row& row, const Fields& columns, size_t i) {
  const auto number = numberIn(row.fields[i]);
  if (!number || !std::isfinite(*number))
    throwInput("{}: `{}` is `{}`; it should be a finite number", row.location, columns[i],
               row.fields[i]);
  if (std::fabs(*number) > kLargestCoordinate)
    throwInput("{}: `{}` is `{}`; it should be between {:g} and {:g}", row.location, columns[i],
               row.fields[i], -kLargestCoordinate, kLargestCoordinate);
  return *number;
}

}  // namespace

std::vector<ObservedPoint> readObservedPoints(const std::filesystem::path& path) {
  const Fields columns{"name", "x", "y", "z", "px", "py"};
  std::vector<ObservedPoint> points;
  std::map<std::string, std::string> locations;
  for (const Row& row : readRows(path, columns, columns.size())) {
    const auto number = [&](size_t i) { return finiteNumber(row, columns, i); };
    points.push_back(
        {row.fields[0], row.location, {number(1), number(2), number(3)}, {number(4), number(5)}});
    const auto [known, isNew] = locations.try_emplace(row.fields[0], row.location);
    if (!isNew)
      throwInput("{}: the name `{}` is also that of {}", row.location, row.fields[0],
                 known->second);
  }
  return points;
}

std::vector<ObservedLine> readObservedLines(const std::filesystem::path& path) {
  const Fields columns{"axis", "x1", "y1", "x2", "y2", "metres"};
  std::vector<ObservedLine> lines;
  for (const Row& row : readRows(path, columns, columns.size() - 1)) {
    const auto number = [&](size_t i) { return finiteNumber(row, columns, i); };
    const std::string& axis = row.fields[0];
    if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z')
      throwInput("{}: `axis` is `{}`; it should be x, y or z", row.location, axis);
    ObservedLine line{
        row.location, axis[0] - 'x', {number(1), number(2)}, {number(3), number(4)}, {}};
    if (line.from == line.to) throwInput("{}: the line's ends are the same", row.location);
    if (row.fields.size() == columns.size() && !row.fields.back().empty()) {
      line.length = number(columns.size() - 1);
      if (!(*line.length > 0)) throwInput("{}: `metres` should be above 0", row.location);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace chromeball
