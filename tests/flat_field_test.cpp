// SPDX-License-Identifier: Apache-2.0
// The flat-field response of a lens, fitted to photographs of a constant source.
#include "image/flat_field.h"
#include "base/json.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "run_command.h"

namespace chromeball::flat_field_test {
namespace {

using nlohmann::json;

constexpr int kWidth = 200, kHeight = 160;
const dvec2 kCentre(kWidth / 2., kHeight / 2.);

// A lens that loses half of the light in the corners: cos^4 of the angle, no polynomial.
double falloff(const dvec2& position) {
  const double tangent = std::sqrt(std::sqrt(2.0) - 1);  // cos^4 is 1/2 in the corners
  const double r = glm::distance(position, kCentre) / (0.5 * std::hypot(kWidth, kHeight));
  return std::pow(1 + std::pow(r * tangent, 2), -2);
}

// A photograph of a disc of radiance 3 in a dark room, centred at `position`.
Image photographOf(const dvec2& position) {
  Image image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const dvec2 pixel(x + 0.5, y + 0.5);
      const double radiance = glm::distance(pixel, position) < 3 ? 3 : 0.01;
      image.setRgb(x, y, Rgb(float(radiance * falloff(pixel))) * Rgb(1, 0.8f, 0.5f));
    }
  return image;
}

std::vector<dvec2> positions() {
  std::vector<dvec2> all;
  for (int i = 0; i < 9; ++i) all.push_back(kCentre + dvec2(96, 76) * (i / 8.));
  return all;
}

double largestError(const Image& flat) {
  double largest = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(flat.rgb(x, y)[c] / falloff({x + 0.5, y + 0.5}) - 1));
  return largest;
}

TEST(FlatField, AFalloffOfHalfIsRecovered) {
  std::vector<SourceSample> samples;
  for (const dvec2& position : positions()) {
    const Image photograph = photographOf(position);
    const dvec2 found = findSource(photograph);
    EXPECT_LT(glm::distance(found, position), 0.5);
    samples.push_back(measureSource(photograph, found, 2, "a"));
  }
  const FlatField field = fitFlatField(samples, kWidth, kHeight, kCentre);
  EXPECT_NEAR(falloff({0, 0}), 0.5, 1e-12);
  EXPECT_EQ(field.at(kCentre), dvec3(1));
  EXPECT_LT(largestError(field.image(kWidth, kHeight)), 0.005);
  EXPECT_LT(std::max({field.rmsError.x, field.rmsError.y, field.rmsError.z}), 0.002);
}

TEST(FlatField, APolynomialIsRecoveredToRounding) {
  const FlatField truth{.centre = {70, 80},
                        .unit = std::hypot(kWidth, kHeight) / 2,
                        .a2 = {-0.5, -0.4, -0.3},
                        .a4 = {0.1, 0.05, -0.1},
                        .a6 = {0.02, 0.01, 0.1},
                        .largest = 2,
                        .rmsError = dvec3(0)};
  std::vector<SourceSample> samples;
  for (int i = 0; i < 7; ++i) {
    const dvec2 position = truth.centre + dvec2(18, 9) * double(i);
    samples.push_back({position, dvec3(2, 3, 4) * truth.at(position)});
  }
  const FlatField field = fitFlatField(samples, kWidth, kHeight, truth.centre);
  EXPECT_LT(glm::distance(field.a2, truth.a2), 1e-9);
  EXPECT_LT(glm::distance(field.a4, truth.a4), 1e-9);
  EXPECT_LT(glm::distance(field.a6, truth.a6), 1e-9);
  // Beyond 1.1 times the largest distance the polynomial keeps its value there.
  const dvec2 outermost = samples.back().position - truth.centre;
  EXPECT_LT(glm::distance(field.at({200, 160}), field.at(truth.centre + 1.1 * outermost)), 1e-12);
}

TEST(FlatField, BadSamplesAreRejected) {
  const auto fit = [](const std::vector<std::pair<double, double>>& radianceAt) {
    std::vector<SourceSample> samples;
    for (const auto& [r, radiance] : radianceAt)
      samples.push_back({kCentre + dvec2(r, 0), dvec3(radiance)});
    return fitFlatField(samples, kWidth, kHeight, kCentre);
  };
  EXPECT_NO_THROW(fit({{0, 1}, {30, 0.9}, {60, 0.8}, {90, 0.6}}));
  EXPECT_THROW(fit({{0, 1}, {30, 0.9}, {60, 0.8}}), InputError);
  EXPECT_THROW(fit({{50, 1}, {50, 1}, {50, 1}, {50, 1}, {50.5, 1}, {20, 1}}), InputError);
  EXPECT_THROW(fit({{0, 1}, {40, 0.2}, {70, 0.01}, {90, 1}}), InputError);  // below 0 between
  Image photograph(20, 10, 3);
  EXPECT_THROW(measureSource(photograph, {10, 5}, 2, "a"), InputError);  // black
  EXPECT_THROW(measureSource(photograph, {19, 5}, 2, "a"), InputError);  // across the edge
  EXPECT_THROW(measureSource(photograph, {-1, 5}, 0, "a"), InputError);
  EXPECT_THROW(measureSource(photograph, {NAN, 5}, 0, "a"), InputError);
}

class SlowCommandFlatField : public testing::Test {
 protected:
  std::string write(const std::string& name, const Image& image) {
    writeImage(folder_ / name, image);
    return folder_ / name;
  }
  std::vector<std::string> series(const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"image", "flat-field"};
    for (const dvec2& position : positions()) {
      const std::string name = fmt::format("s{}.exr", arguments.size());
      arguments.push_back(write(name, photographOf(position)));
    }
    arguments.insert(arguments.end(), options.begin(), options.end());
    return arguments;
  }
  TemporaryFolder folder_;
};

TEST_F(SlowCommandFlatField, FitsAndDivides) {
  const std::string flat = folder_ / "flat.exr", out = folder_ / "out.exr";
  const CommandResult result = runCommand(series({"-o", flat, "--json"}));
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_LT(largestError(readImage(flat)), 0.005);
  const json fit = parseJson(result.out);
  EXPECT_EQ(fit["samples"].size(), 9u);
  EXPECT_LT(fit["a2"][0].get<double>(), -0.5);

  Image shaded(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) shaded.setRgb(x, y, Rgb(float(falloff({x + 0.5, y + 0.5}))));
  EXPECT_EQ(runCommand({"image", "divide", write("in.exr", shaded), flat, "-o", out}).status, 0);
  for (const float channel : readImage(out).texels) EXPECT_NEAR(channel, 1, 0.005);
}

TEST_F(SlowCommandFlatField, PositionsMayBeGiven) {
  std::vector<std::string> options{"-o", folder_ / "flat.exr"};
  for (const dvec2& position : positions())
    options.insert(options.end(), {"--at", fmt::format("{},{}", position.x, position.y)});
  const CommandResult result = runCommand(series(options));
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.out.find("samples     9"), std::string::npos) << result.out;
  EXPECT_LT(largestError(readImage(folder_ / "flat.exr")), 0.005);
}

TEST_F(SlowCommandFlatField, BadInputIsRejected) {
  const std::string flat = folder_ / "flat.exr", one = write("one.exr", photographOf(kCentre));
  expectError({"image", "flat-field", one, one, one, one, "-o", flat},
              "at 1 different distance from the centre");
  expectError({"image", "flat-field", one, "-o", flat, "--at", "1,2", "--at", "3,4"},
              "2 positions for 1 photographs");
  expectError({"image", "flat-field", one, "-o", flat, "--at", "1,80"}, "is not inside");
  expectError({"image", "flat-field", one, "-o", flat, "--radius", "-1"}, "--radius");
  expectError({"image", "flat-field", one, "-o", flat, "--centre", "1"}, "--centre");
  expectError({"image", "flat-field", one, "-o", flat, "--centre", "1e9,5"},
              "--centre: (1e+09, 5)");
  expectError({"image", "flat-field", one, write("small.exr", Image(4, 4, 3)), "-o", flat},
              "have one size");
  Image white(kWidth, kHeight, 3);
  for (float& texel : white.texels) texel = 1;
  expectError({"image", "flat-field", write("white.png", white), "-o", flat}, "is saturated");
  expectError({"image", "flat-field", one, "-o", one}, "would overwrite");
  expectError({"image", "divide", one, folder_ / "small.exr", "-o", flat}, "same size");
  expectError({"image", "divide", one, one, "-o", one}, "would overwrite");
  EXPECT_FALSE(std::filesystem::exists(flat));
}

TEST_F(SlowCommandFlatField, DivisionByZeroIsZeroWithAWarning) {
  Image a(2, 1, 3), b(2, 1, 3);
  a.setRgb(0, 0, Rgb(1, 2, 3)), a.setRgb(1, 0, Rgb(1));
  b.setRgb(0, 0, Rgb(2, 0, -1)), b.setRgb(1, 0, Rgb(4));
  Image clipped(2, 1, 1);
  *clipped.at(1, 0) = 1;
  writeImage(folder_ / "a.exr",
             OutputImage{{{"", "RGB", a}, {"clipped", "", clipped}}, {}, {}, {}});
  const CommandResult result = runCommand(
      {"image", "divide", folder_ / "a.exr", write("b.exr", b), "-o", folder_ / "c.exr"});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.error.find("1 pixels have a channel"), std::string::npos) << result.error;
  const ImageFile file = readImageFile(folder_ / "c.exr");
  EXPECT_EQ(findColor(file)->rgb(0, 0), Rgb(0.5f, 0, 0));
  EXPECT_EQ(findColor(file)->rgb(1, 0), Rgb(0.25f));
  EXPECT_EQ(findLayer(file, "clipped")->texels, clipped.texels);
}

}  // namespace
}  // namespace chromeball::flat_field_test
