// SPDX-License-Identifier: Apache-2.0
#include "study/report/report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "base/json.h"
#include "image/io/write_image.h"
#include "measure/false_color.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDecades = 3;  // spanned by the scale of the error maps
constexpr double kMaxZ = 5;

std::string base64(std::span<const uint8_t> bytes) {
  static constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t j = 0; j < 3; ++j) bits = bits << 8 | (i + j < bytes.size() ? bytes[i + j] : 0);
    for (size_t j = 0; j < 4; ++j)
      text += i + j > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * j) & 63];
  }
  return text;
}

// Radiance with 8-bit mantissas and a shared exponent (Ward 1991).
Json radianceUris(const Image& image) {
  std::vector<uint8_t> mantissas, exponents;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb color = glm::max(image.rgb(x, y), Rgb(0));
      int exponent = 0;
      const float maximum = maxComponent(color);
      const float fraction = maximum > 1e-32f ? std::frexp(maximum, &exponent) : 0;
      const float scale = fraction > 0 ? fraction * 256 / maximum : 0;
      for (int c = 0; c < 3; ++c) mantissas.push_back(uint8_t(std::min(255.0f, color[c] * scale)));
      exponents.push_back(uint8_t(fraction > 0 ? std::clamp(exponent + 128, 0, 255) : 0));
    }
  return {{"rgb", pngUri(image.width, image.height, 3, mantissas)},
          {"exponent", pngUri(image.width, image.height, 1, exponents)}};
}

std::vector<Image> loadImages(const RenderStore& store, const Cell& cell) {
  std::vector<Image> images;
  for (int repeat = 0; repeat < int(cell.repeatSeconds.size()); ++repeat)
    images.push_back(store.find({cell.strategy, cell.budget, repeat}).value().image);
  return images;
}

// A map of the root of the mean squared relative error over repeats and channels.
Image relativeError(std::span<const Image> repeats, const Image& reference) {
  Image error(reference.width, reference.height, 1);
  for (size_t i = 0; i < error.texels.size(); ++i) {
    double sum = 0;
    for (const Image& image : repeats)
      for (size_t j = 3 * i; j < 3 * i + 3; ++j) {
        const double truth = reference.texels[j];
        sum += std::pow(image.texels[j] - truth, 2) / (truth * truth + 0.01);
      }
    error.texels[i] = float(std::sqrt(sum / 3 / double(repeats.size())));
  }
  return error;
}

// A map of the relative bias of luminance; 0 where it is within two standard errors.
Image significantBias(std::span<const Image> repeats, const Reference& reference) {
  Image bias(reference.mean.width, reference.mean.height, 1);
  const double n = double(repeats.size());
  for (int y = 0; y < bias.height; ++y)
    for (int x = 0; x < bias.width; ++x) {
      const double truth = luminance(reference.mean.rgb(x, y));
      double sum = 0, sumOfSquares = 0;
      for (const Image& image : repeats) {
        const double difference = luminance(image.rgb(x, y)) - truth;
        sum += difference;
        sumOfSquares += difference * difference;
      }
      const double mean = sum / n;
      double squaredError = std::max(0.0, (sumOfSquares - sum * mean) / (n - 1) / n);
      if (!reference.squaredError.empty())
        squaredError += luminance(reference.squaredError.rgb(x, y));
      if (std::fabs(mean) > 2 * std::sqrt(squaredError))
        *bias.at(x, y) = float(mean / std::sqrt(truth * truth + 0.01));
    }
  return bias;
}

template <class Level>  // maps a number to [0, 255]
std::string mapUri(const Image& map, const Level& level) {
  std::vector<uint8_t> bytes;
  for (const float number : map.texels)
    bytes.push_back(uint8_t(std::lround(std::clamp(double(level(number)), 0.0, 255.0))));
  return pngUri(map.width, map.height, 1, bytes);
}

auto signedLevel(double maximum) {
  return [maximum](float number) { return 128 + 127 * std::clamp(number / maximum, -1.0, 1.0); };
}

template <class Color>
Json colorTable(const Color& color) {
  Json table = Json::array();
  for (int level = 0; level < 256; ++level) {
    const Color8 c = color(level);
    table.push_back({c[0], c[1], c[2]});
  }
  return table;
}

// The end of a scale for all maps: the 99th percentile of the nonzero numbers, rounded up.
double commonScale(const std::vector<Image>& maps) {
  std::vector<float> numbers;
  for (const Image& map : maps)
    for (const float number : map.texels)
      if (number != 0) numbers.push_back(std::fabs(number));
  return roundUp(percentile(std::move(numbers), 0.99));
}

// The cell of each strategy whose render time is nearest to the longest time that all strategies
// reach.
std::vector<const Cell*> equalTimeCells(const StudyResults& results) {
  double seconds = std::numeric_limits<double>::max();
  for (const StrategyResult& strategy : results.strategies)
    if (!strategy.cells.empty()) seconds = std::min(seconds, strategy.cells.back().seconds.mean);
  std::vector<const Cell*> cells;
  for (const StrategyResult& strategy : results.strategies) {
    const Cell* nearest = nullptr;
    for (const Cell& cell : strategy.cells) {
      const auto distance = [&](const Cell& c) {
        return std::fabs(std::log(c.seconds.mean / seconds));
      };
      if (!nearest || distance(cell) < distance(*nearest)) nearest = &cell;
    }
    if (nearest) cells.push_back(nearest);
  }
  return cells;
}

void addImages(Json& json, const RenderStore& store, const StudyResults& results) {
  std::vector<Image> errors;
  json["images"] = Json::array();
  for (const Cell* cell : equalTimeCells(results)) {
    const std::vector<Image> repeats = loadImages(store, *cell);
    errors.push_back(relativeError(repeats, results.reference.mean));
    Json image = {{"name", cell->strategy},
                  {"budget", cell->budget.label()},
                  {"samples", cell->samples},
                  {"seconds", cell->seconds.mean}};
    image.update(radianceUris(repeats[0]));
    json["images"].push_back(std::move(image));
  }
  const double maximum = commonScale(errors);
  json["errorScale"] = {{"max", maximum}, {"decades", kDecades}};
  for (size_t i = 0; i < errors.size(); ++i)
    json["images"][i]["error"] =
        mapUri(errors[i], [&](float number) { return 255 * logLevel(number, maximum, kDecades); });
}

void addBias(Json& json, const RenderStore& store, const StudyResults& results) {
  std::vector<Image> maps;
  json["bias"] = Json::array();
  for (const StrategyResult& strategy : results.strategies) {
    if (strategy.unbiased || strategy.cells.empty()) continue;
    const Cell& cell = strategy.cells.back();
    maps.push_back(significantBias(loadImages(store, cell), results.reference));
    json["bias"].push_back({{"name", strategy.name}, {"budget", cell.budget.label()}});
  }
  const double maximum = commonScale(maps);
  json["biasScale"] = {{"max", maximum}};
  for (size_t i = 0; i < maps.size(); ++i)
    json["bias"][i]["map"] = mapUri(maps[i], signedLevel(maximum));
}

}  // namespace

std::string pngUri(int width, int height, int channels, std::span<const uint8_t> bytes) {
  return "data:image/png;base64," + base64(encodePng(width, height, channels, bytes));
}

Json reportImages(const RenderStore& store, const StudyResults& results) {
  const Image& reference = results.reference.mean;
  Json json = {{"width", reference.width},
               {"height", reference.height},
               {"heat", colorTable([](int level) { return heatColor(level / 255.0); })},
               {"signed", colorTable([](int level) { return signedColor((level - 128) / 127.0); })},
               {"reference", radianceUris(reference)}};
  addImages(json, store, results);
  addBias(json, store, results);
  json["zScale"] = kMaxZ;
  json["pairs"] = Json::array();
  for (const PairResult& pair : results.pairs) {
    const Image& z = pair.agreement.z;
    json["pairs"].push_back({{"a", pair.a},
                             {"b", pair.b},
                             {"width", z.width},
                             {"height", z.height},
                             {"map", mapUri(z, signedLevel(kMaxZ))}});
  }
  return json;
}

std::vector<vec3> sampledDirections(const LightSource& strategy) {
  constexpr uint32_t kSamples = 128;
  const SobolTable table(kSamples, dimension::kVertex + dimension::kPerVertex, 0);
  PixelSampler sampler(table, 0);
  sampler.startPixel(0, 0, 0);
  std::vector<DirectionSample> samples;
  for (uint32_t i = 0; i < kSamples; ++i) {
    sampler.startSample(i);
    sampler.startVertex(0);
    strategy.sample({vec3(0), vec3(0, 1, 0), nullptr, 0}, sampler, samples);
  }
  std::set<std::tuple<float, float, float>> seen;
  std::vector<vec3> directions;
  for (const DirectionSample& sample : samples)
    if (seen.insert({sample.wi.x, sample.wi.y, sample.wi.z}).second)
      directions.push_back(sample.wi);
  return directions;
}

}  // namespace chromeball
