// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/observations.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <tuple>

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

// The field without surrounding spaces and quotation marks; messages quote it, so control
// characters become question marks.
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

namespace {

using glm::dvec2, glm::dvec3;

// The part of a line inside a rectangle around the picture (Liang and Barsky 1984); false if there
// is none.
bool clip(dvec2& from, dvec2& to, const dvec2& min, const dvec2& max) {
  double begin = 0, end = 1;
  const dvec2 along = to - from;
  if (!std::isfinite(along.x + along.y)) return false;
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const double limit = side < 0 ? from[axis] - min[axis] : max[axis] - from[axis];
      const double speed = side * along[axis];
      if (speed == 0 && limit < 0) return false;
      if (speed > 0) end = std::min(end, limit / speed);
      if (speed < 0) begin = std::max(begin, limit / speed);
    }
  if (!(begin < end)) return false;
  to = from + end * along;
  from += begin * along;
  return true;
}

using Corner = std::tuple<float, float, float>;
Corner cornerAt(const vec3& p) { return {p.x, p.y, p.z}; }

// The data of an edge while its triangles are visited.
struct Fold {
  vec3 from, to;
  dvec3 normal;  // of its first triangle
  int triangles = 0;
  bool bends = false;
};

void addCreases(const Scene& scene, const Instance& instance, std::vector<ModelEdge>& edges) {
  const double straight = std::cos(glm::radians(30.0));
  const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
  std::map<std::pair<Corner, Corner>, Fold> folds;
  for (const Triangle& triangle : mesh.triangles) {
    vec3 p[3];
    for (int i = 0; i < 3; ++i) p[i] = instance.point(mesh.positions[triangle[i]]);
    const dvec3 across = glm::cross(dvec3(p[1] - p[0]), dvec3(p[2] - p[0]));
    if (!(glm::length(across) > 0)) continue;
    const dvec3 normal = glm::normalize(across);
    for (int i = 0; i < 3; ++i) {
      const vec3 a = p[i], b = p[(i + 1) % 3];
      Fold& fold = folds[std::minmax({cornerAt(a), cornerAt(b)})];
      if (fold.triangles++ == 0)
        fold.from = a, fold.to = b, fold.normal = normal;
      else
        fold.bends |= std::abs(glm::dot(fold.normal, normal)) < straight;
    }
  }
  for (const auto& [key, fold] : folds)
    if (fold.triangles == 1 || fold.bends) edges.push_back({fold.from, fold.to});
}

}  // namespace

PictureLines::PictureLines(Image& picture)
    : picture_(picture), width_(std::max(1.2, std::hypot(picture.width, picture.height) / 1000)) {}

void PictureLines::line(dvec2 from, dvec2 to, const Rgb& color) {
  const dvec2 size(picture_.width, picture_.height);
  if (!clip(from, to, dvec2(-width_), size + width_)) return;
  const dvec2 along = to - from;
  const double length2 = glm::dot(along, along), reach = 0.5 * width_ + 1;
  const int axis = std::abs(along.x) > std::abs(along.y) ? 0 : 1;  // steps along the longer one
  const double slope = along[axis] != 0 ? along[1 - axis] / along[axis] : 0;
  const double across = reach * std::sqrt(1 + slope * slope);
  const auto bound = [&](double x, int i) { return int(std::clamp(x, 0.0, size[i])); };
  for (int step = bound(std::min(from[axis], to[axis]) - reach, axis);
       step < bound(std::max(from[axis], to[axis]) + reach + 1, axis); ++step) {
    const double middle = from[1 - axis] + slope * (step + 0.5 - from[axis]);
    for (int other = bound(middle - across, 1 - axis); other < bound(middle + across + 1, 1 - axis);
         ++other) {
      const int x = axis == 0 ? step : other, y = axis == 0 ? other : step;
      const dvec2 offset = dvec2(x + 0.5, y + 0.5) - from;
      const double t = length2 > 0 ? std::clamp(glm::dot(offset, along) / length2, 0.0, 1.0) : 0;
      const double distance = glm::length(offset - t * along);
      const float covered = float(std::clamp(0.5 * width_ + 0.5 - distance, 0.0, 1.0));
      picture_.setRgb(x, y, glm::mix(picture_.rgb(x, y), color, covered));
    }
  }
}

void PictureLines::cross(const dvec2& at, const Rgb& color) {
  const double size = markSize();
  line(at - dvec2(size), at + dvec2(size), color);
  line(at + dvec2(size, -size), at + dvec2(-size, size), color);
}

void PictureLines::circle(const dvec2& at, const Rgb& color) {
  constexpr int kSides = 24;
  const auto corner = [&](int i) {
    const double angle = 2 * kPiD * i / kSides;
    return at + markSize() * dvec2(std::cos(angle), std::sin(angle));
  };
  for (int i = 0; i < kSides; ++i) line(corner(i), corner(i + 1), color);
}

std::vector<ModelEdge> creases(const Scene& scene) {
  std::vector<ModelEdge> edges;
  for (const Instance& instance : scene.instances) addCreases(scene, instance, edges);
  return edges;
}

void drawEdges(std::span<const ModelEdge> edges, const Camera& camera, const Rgb& color,
               Image& picture) {
  const dvec2 size(picture.width, picture.height);
  const CameraView view(camera, size.x / size.y);
  PictureLines lines(picture);
  const int parts = camera.distortion ? 16 : 1;
  const dvec3 forward(-camera.back), position(camera.position);
  for (const ModelEdge& edge : edges) {
    dvec3 from(edge.from), to(edge.to);
    const double nearFrom = glm::dot(from - position, forward);
    const double nearTo = glm::dot(to - position, forward);
    const double closest = 1e-3 * std::max(nearFrom, nearTo);  // what is nearer is left out
    if (!(closest > 0)) continue;
    if (nearFrom < closest) from = glm::mix(from, to, (closest - nearFrom) / (nearTo - nearFrom));
    if (nearTo < closest) to = glm::mix(to, from, (closest - nearTo) / (nearFrom - nearTo));
    std::optional<CameraView::Point> last = view.at(from);
    for (int i = 1; i <= parts; ++i) {
      const auto next = view.at(glm::mix(from, to, double(i) / parts));
      if (last && next) lines.line(size * last->position, size * next->position, color);
      last = next;
    }
  }
}

}  // namespace chromeball
