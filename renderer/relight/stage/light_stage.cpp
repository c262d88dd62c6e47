// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/light_stage.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "base/error.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "image/io/read_image.h"
#include "math/vec.h"

namespace chromeball {

int stageChannels(const DirectionBasis& basis) {
  constexpr int kOthers = 6;  // colour, and the scene's own light
  return 3 * basis.size() + kOthers;
}

void checkStageSize(const DirectionBasis& basis, int width, int height, std::string_view location) {
  const uint64_t numbers = uint64_t(width) * uint64_t(height) * uint64_t(stageChannels(basis));
  if (numbers > kMaxStageNumbers)
    throwInput(
        "{}: {} x {} pixels with {} elements are {} numbers; the limit is {}: take a smaller "
        "size or fewer directions",
        location, width, height, basis.size(), numbers, kMaxStageNumbers);
}

double elementBytes(const DirectionBasis& basis) { return 3. * sizeof(float) * basis.size(); }

void checkInMemory(const DirectionBasis& basis, int width, int height, double memory,
                   std::string_view location) {
  const double bytes = elementBytes(basis) * width * height;
  if (bytes > memory)
    throwInput("{}: {} elements of {} x {} pixels take {:.3g} GB of memory; {:.3g} GB are left",
               location, basis.size(), width, height, 1e-9 * bytes, 1e-9 * std::max(memory, 0.0));
}

std::vector<Rgb> lightWeights(const DirectionBasis& basis, const Image& latLong,
                              const Rotation& rotation, int leastWidth) {
  const Probe probe(latLong);
  const auto fine = [](int texels, int least) { return texels * ((least + texels - 1) / texels); };
  // The harmonics are smooth, and a search for the nearest direction is slow.
  if (!basis.hasCells() || basis.kind() == DirectionBasis::Nearest)
    leastWidth = std::min(leastWidth, 1024);
  const ImageSize grid{fine(latLong.width, leastWidth), fine(latLong.height, leastWidth / 2)};
  const auto count = size_t(basis.size());
  const auto sums = sumOverSphere<glm::dvec4>(
      grid, count, [&](const dvec3& d, double solidAngle, std::vector<glm::dvec4>& elements) {
        const glm::dvec4 light(dvec3(probe.radiance(vec3(d))), 1);
        basis.forValues(vec3(rotation(d)), [&](int element, float value) {
          elements[size_t(element)] += solidAngle * double(value) * light;
        });
      });
  std::vector<Rgb> weights(count, Rgb(0));
  for (size_t i = 0; i < count; ++i) {
    if (!basis.hasCells()) weights[i] = Rgb(sums[i]);
    // A cell that is smaller than the grid's texels may have none.
    else if (sums[i].w > 0)
      weights[i] = Rgb(dvec3(sums[i]) / sums[i].w);
  }
  return weights;
}

Image reflectanceFunction(const LightStage& stage, int x, int y) {
  const DirectionBasis& basis = stage.basis;
  const bool isBoxes = basis.kind() == DirectionBasis::LatLong;
  Image map(isBoxes ? basis.columns() : 64, isBoxes ? basis.rows() : 32, 3);
  const std::vector<double> solidAngles =
      basis.hasCells() ? cellSolidAngles(basis) : std::vector<double>(size_t(basis.size()), 1);
  const float* elements = stage.elements.at(x, y);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column) {
      Rgb sum(0);
      basis.forValues(
          vec3(texelDirection({map.width, map.height}, column, row)), [&](int i, float value) {
            const Rgb element(elements[3 * i], elements[3 * i + 1], elements[3 * i + 2]);
            sum += element * (value / float(solidAngles[size_t(i)]));
          });
      map.setRgb(column, row, sum);
    }
  return map;
}

namespace {

namespace fs = std::filesystem;

std::string trimmed(std::string_view field) {
  const size_t first = field.find_first_not_of(" \t"), last = field.find_last_not_of(" \t");
  return std::string(first == field.npos ? "" : field.substr(first, last - first + 1));
}

// In quotation marks, as spreadsheets write them, a field may have commas; a doubled mark is one
// (RFC 4180, section 2).
std::vector<std::string> fieldsOf(std::string_view line) {
  std::vector<std::string> fields;
  std::string field;
  bool isQuoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && (isQuoted || trimmed(field).empty())) {
      const bool isDoubled = isQuoted && line.substr(i + 1).starts_with('"');
      if (isDoubled) field += line[i++];
      isQuoted = isDoubled || !isQuoted;
    } else if (line[i] == ',' && !isQuoted) {
      fields.push_back(trimmed(field));
      field.clear();
    } else {
      field += line[i];
    }
  }
  if (!field.empty() || fields.empty()) fields.push_back(trimmed(field));
  return fields;
}

// The numbers after the file's name; nullopt unless all are finite numbers.
std::optional<std::vector<double>> numbersOf(const std::vector<std::string>& fields) {
  std::vector<double> numbers;
  for (size_t i = 1; i < fields.size(); ++i) {
    double number = 0;
    if (!toNumber(fields[i], number) || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

// Whether the line has names of columns: nothing after the first field begins like a number.
bool isHeading(const std::vector<std::string>& fields) {
  return std::none_of(fields.begin() + 1, fields.end(), [](const std::string& field) {
    double number = 0;
    std::string_view text = field;
    return takeNumber(text, number);
  });
}

class PhotographList {
 public:
  explicit PhotographList(const fs::path& csv) : csv_(csv) {}

  void add(const std::vector<std::string>& fields, int line) {
    const auto numbers = numbersOf(fields);
    const size_t count = fields.size() - 1;
    if (!numbers || fields[0].empty() || (count != 2 && count != 3)) {
      if (line == 1 && isHeading(fields)) return;
      fail(line, "should be FILE,X,Y,Z or FILE,AZIMUTH,ELEVATION");
    }
    if (columns_ > 0 && count != columns_)
      fail(line, fmt::format("has {} numbers, and the lines before {}", count, columns_));
    columns_ = count;
    if (const auto [before, isNew] = lines_.try_emplace(fields[0], line); !isNew)
      fail(line, fmt::format("`{}` is on line {} too", fields[0], before->second));
    const dvec3 direction = directionOf(*numbers, line);
    for (size_t i = 0; i < photographs.size(); ++i)
      if (glm::distance(dvec3(photographs[i].direction), direction) < kLeastDistance)
        fail(line, fmt::format("has the direction of `{}`", photographs[i].file));
    if (photographs.size() == size_t(DirectionBasis::kMaxElements))
      fail(line, fmt::format("exceeds the limit of {} photographs", DirectionBasis::kMaxElements));
    photographs.push_back({fields[0], vec3(direction)});
  }

  std::vector<StagePhotograph> photographs;

 private:
  static constexpr double kLeastDistance = 1e-4;  // on the unit sphere

  [[noreturn]] void fail(int line, const std::string& reason) const {
    throwInput("{}:{}: {}", csv_.string(), line, reason);
  }

  dvec3 directionOf(const std::vector<double>& numbers, int line) const {
    if (numbers.size() == 2) {
      if (std::fabs(numbers[1]) > 90) fail(line, "the elevation is not from -90 to 90 degrees");
      return directionAt(numbers[0], numbers[1]);
    }
    const dvec3 direction = unitOrZero({numbers[0], numbers[1], numbers[2]});
    if (direction == dvec3(0)) fail(line, "the direction has no length");
    return direction;
  }

  fs::path csv_;
  size_t columns_ = 0;
  std::map<std::string, int> lines_;  // by file
};

void copyScaled(const Image& image, float scale, int element, const fs::path& path,
                Image& elements) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb color = image.rgb(x, y) * scale;
      if (!isFinite(color))
        throwInput("{}: pixel {}, {} has values that are not finite", path.string(), x, y);
      for (int c = 0; c < 3; ++c) elements.at(x, y)[3 * element + c] = color[c];
    }
}

}  // namespace

std::vector<StagePhotograph> readPhotographs(const fs::path& csv) {
  const std::vector<uint8_t> bytes = readFile(csv);
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::string contents(bytes.begin(), bytes.end());
  if (contents.starts_with(kByteOrderMark)) contents.erase(0, kByteOrderMark.size());
  std::istringstream text(std::move(contents));
  PhotographList list(csv);
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") == std::string::npos || line.front() == '#') continue;
    list.add(fieldsOf(line), number);
  }
  if (list.photographs.empty()) throwInput("{}: names no photographs", csv.string());
  return std::move(list.photographs);
}

LightStage stageOf(const fs::path& folder, const std::vector<StagePhotograph>& photographs,
                   float irradiance, double memory, Messages& messages) {
  std::vector<vec3> directions;
  for (const StagePhotograph& photograph : photographs) {
    checkReadable(folder / photograph.file);
    directions.push_back(photograph.direction);
  }
  LightStage stage{DirectionBasis(directions), {}, {}};
  const std::vector<double> solidAngles = cellSolidAngles(stage.basis);
  for (size_t i = 0; i < photographs.size(); ++i) {
    const fs::path path = folder / photographs[i].file;
    ImageFile file = readImageFile(path);
    messages.insert(messages.end(), file.messages.begin(), file.messages.end());
    const Messages clipped = clippedLight(file, path);
    messages.insert(messages.end(), clipped.begin(), clipped.end());
    const Image image = colorOf(std::move(file), path);
    if (i == 0) {
      checkInMemory(stage.basis, image.width, image.height, memory, path.string());
      stage.elements = Image(image.width, image.height, 3 * stage.basis.size());
    }
    if (image.width != stage.width() || image.height != stage.height())
      throwInput("{}: has {} x {} pixels; {} has {} x {}", path.string(), image.width, image.height,
                 photographs[0].file, stage.width(), stage.height());
    copyScaled(image, float(solidAngles[i]) / irradiance, int(i), path, stage.elements);
  }
  return stage;
}

}  // namespace chromeball
