// SPDX-License-Identifier: Apache-2.0
// One row of a probe as importance sampling draws from it, and its plot.
#include <gtest/gtest.h>

#include <numeric>

#include "base/error.h"
#include "image/io/write_image.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "regular_expression.h"
#include "run_command.h"
#include "shared_data.h"
#include "study/report/row_distribution.h"
#include "test_probes.h"

namespace chromeball::row_plot_test {
namespace {

RowDistribution distributionOf(const Image& image, int row, const AzimuthRange& range, int samples,
                               float rotation = 0) {
  const Probe probe(image, rotation);
  return rowDistribution(probe, Importance(probe, false), row, range, samples, "here");
}

TEST(RowDistribution, OfAConstantProbeIsALine) {
  for (const ImageSize& size : {ImageSize{64, 32}, {2, 1}, {1, 1}, {3, 7}})
    for (const float radiance : {1e-8f, 1.f, 1e10f})
      for (const float rotation : {0.f, 130.f}) {
        const RowDistribution row =
            distributionOf(constantProbe(size, Rgb(radiance)), size.height / 2, {}, 8, rotation);
        const auto cells = size_t(size.width);
        ASSERT_EQ(row.luminances.size(), cells);
        ASSERT_EQ(row.cdf.size(), cells + 1);
        EXPECT_EQ(row.cdf.back(), 1);
        EXPECT_NEAR(row.share, 1, 1e-12);
        EXPECT_NEAR(row.azimuths.front() - row.azimuths.back(), 360, 1e-9);
        for (size_t i = 0; i <= cells; ++i) EXPECT_NEAR(row.cdf[i], double(i) / cells, 1e-6);
        for (const double l : row.luminances) EXPECT_FLOAT_EQ(float(l), radiance);
        for (const RowDistribution::Sample& sample : row.samples)
          EXPECT_NEAR((row.azimuths.front() - sample.azimuth) / 360, sample.number, 1e-5);
      }
}

// Row 9 has one bright texel: the samples lie between the centres of the texels beside it.
TEST(RowDistribution, SamplesFindTheLight) {
  const Image image = spot(32, 16, 5, 9, 1e6f, 1e-3f);
  const int row = 9;
  EXPECT_EQ(row, texelRowAt(Probe(image), 90 - 180 * 9.1 / 16));
  EXPECT_EQ(row, brightestRow(Probe(image), Importance(Probe(image), false)));
  const double azimuth = 180 - 360 * 5.5 / 32;
  const RowDistribution all = distributionOf(image, row, {}, 100);
  EXPECT_NEAR(all.elevation, 90 - 180 * 9.5 / 16, 1e-12);
  for (const RowDistribution::Sample& sample : all.samples)
    EXPECT_NEAR(sample.azimuth, azimuth, 360. / 32);
  EXPECT_NEAR(all.samples[50].azimuth, azimuth, 0.5);

  // The same light in a rotated probe, in a range across the seam.
  const RowDistribution part = distributionOf(image, row, {200, 150}, 11, 60);
  EXPECT_NEAR(part.share, 1, 1e-6);
  EXPECT_NEAR(part.samples[5].azimuth, azimuth + 60, 0.5);
  EXPECT_LE(part.luminances.size(), 7u);
  EXPECT_EQ(part.cdf.back(), 1);
}

// Samples lie where the cdf has their number, up to the density within a cell.
TEST(RowDistribution, SamplesInvertTheCdf) {
  const Image image = gradientProbe({64, 32}, Rgb(1), {0.9, 0.1, 0.3});
  for (const AzimuthRange& range : {AzimuthRange{}, {-20, -300}, {40, 39}}) {
    const RowDistribution row = distributionOf(image, 20, range, 50);
    EXPECT_GE(row.azimuths.front(), range.left - 360. / 64);
    for (const RowDistribution::Sample& sample : row.samples) {
      size_t cell = 0;
      while (cell + 2 < row.cdf.size() && row.azimuths[cell + 1] > sample.azimuth) ++cell;
      EXPECT_GE(sample.number, row.cdf[cell] - 1e-4);
      EXPECT_LE(sample.number, row.cdf[cell + 1] + 1e-4);
    }
    for (size_t i = 0; i + 1 < row.cdf.size(); ++i) EXPECT_LE(row.cdf[i], row.cdf[i + 1]);
  }
}

TEST(RowDistribution, ShowsTheTexelsOfTheRow) {
  const Image image = studioProbe({64, 32});
  for (const int y : {0, 9, 31}) {
    const RowDistribution row = distributionOf(image, y, {}, 0);
    EXPECT_EQ(row.row, y);
    EXPECT_NEAR(row.elevation, 90 - 180 * (y + 0.5) / 32, 1e-12);
    EXPECT_EQ(row.azimuths.front(), 180);
    ASSERT_EQ(row.luminances.size(), 64u);
    for (int x = 0; x < 64; ++x)
      EXPECT_EQ(row.luminances[size_t(x)], double(luminance(image.rgb(x, y))));
  }
}

// The cdf integrates the sampler's pdf along the middle of the row.
TEST(RowDistribution, HasThePdfOfImportance) {
  const Image image = studioProbe({64, 32});
  const Probe probe(image);
  for (const bool compensated : {false, true}) {
    const Importance importance(probe, compensated);
    const RowDistribution row = rowDistribution(probe, importance, 9, {}, 0, "here");
    constexpr int kSteps = 200;
    std::vector<double> masses;
    for (size_t i = 0; i + 1 < row.cdf.size(); ++i) {
      double mass = 0;
      for (int step = 0; step < kSteps; ++step) {
        const double at = (step + 0.5) / kSteps;
        const double azimuth = row.azimuths[i] + at * (row.azimuths[i + 1] - row.azimuths[i]);
        mass += double(importance.pdf(vec3(directionAt(azimuth, row.elevation)))) / kSteps;
      }
      masses.push_back(mass);
    }
    const double all = std::accumulate(masses.begin(), masses.end(), 0.);
    for (size_t i = 0; i < masses.size(); ++i)
      EXPECT_NEAR(row.cdf[i + 1] - row.cdf[i], masses[i] / all, 1e-4) << i;
  }
}

TEST(RowDistribution, ThrowsWhereNothingIsSampled) {
  EXPECT_THROW(distributionOf(constantProbe({8, 4}, Rgb(0)), 2, {}, 4), InputError);
  EXPECT_THROW(distributionOf(spot(8, 4, 1, 0, 1, 0), 3, {}, 4), InputError);
  EXPECT_THROW(distributionOf(spot(64, 32, 1, 16, 1, 0), 16, {10, -10}, 4), InputError);
  EXPECT_NEAR(distributionOf(constantProbe({8, 4}, Rgb(3.3e38f)), 2, {}, 4).cdf[4], 0.5, 1e-6);
}

// HDRI book, figure 9.36: most samples fall on a few texels of the row, its windows.
TEST(SlowRowDistribution, WindowsOfSaintPeters) {
  const auto path = sharedData("probes/debevec/stpeters_cross.hdr");
  if (!path) GTEST_SKIP() << "no probes/debevec/stpeters_cross.hdr";
  const Image image = loadProbe(*path).latLong;
  const RowDistribution row = distributionOf(image, texelRowAt(Probe(image), 17), {}, 1000);
  EXPECT_EQ(row.cdf.back(), 1);
  std::vector<size_t> order(row.luminances.size());
  std::iota(order.begin(), order.end(), size_t(0));
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return row.luminances[a] > row.luminances[b]; });
  std::vector<bool> isBright(order.size());
  for (size_t i = 0; i < order.size() / 20; ++i) isBright[order[i]] = true;
  size_t samples = 0, cell = 0;
  for (const RowDistribution::Sample& sample : row.samples) {
    while (cell + 1 < isBright.size() && row.azimuths[cell + 1] > sample.azimuth) ++cell;
    samples += isBright[cell];
  }
  EXPECT_GE(samples, 500u);
}

// Whether a coordinate is not a finite number.
bool hasInvalidNumber(const std::string& svg) {
  return containsMatch(svg.substr(0, svg.find("data:")), "[MLHVvh \"]-?(nan|inf)[MLHVvhz \"]");
}

size_t countOf(const std::string& text, const std::string& word) {
  size_t count = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

TEST(RowPlot, HasAnArrowForEachSample) {
  const Image image = gradientProbe({64, 32}, Rgb(1), {0.9, 0.1, 0.3});
  const Probe probe(image);
  const std::string svg = rowPlot(probe, distributionOf(image, 16, {90, -90}, 7), "A & B <0.exr>");
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  EXPECT_NE(svg.find("A &amp; B &lt;0.exr>"), std::string::npos);
  EXPECT_NE(svg.find("data:image/png;base64,"), std::string::npos);
  EXPECT_EQ(countOf(svg, "<g"), countOf(svg, "</g>"));
  EXPECT_FALSE(hasInvalidNumber(svg));
  const size_t samples = svg.find("class=\"samples\""), end = svg.find("</g>", samples);
  EXPECT_EQ(countOf(svg.substr(samples, end - samples), "H"), 7u);
}

// Black texels are at 0, below the axis' powers of ten, and not at the least of these.
TEST(RowPlot, BlackIsBelowTheAxis) {
  Image image = constantProbe({4, 2}, Rgb(1));
  const auto pathOf = [&] {
    const std::string svg = rowPlot(Probe(image), distributionOf(image, 0, {}, 0), "a");
    const size_t at = svg.find("class=\"luminance\" d=\"");
    EXPECT_NE(at, std::string::npos);
    return svg.substr(at + 21, svg.find('"', at + 21) - at - 21);
  };
  EXPECT_EQ(pathOf(), "M72.0 236.0H288.0L288.0 236.0H504.0L504.0 236.0H720.0L720.0 236.0H936.0");
  image.setRgb(1, 0, Rgb(0));
  EXPECT_EQ(pathOf(), "M72.0 218.0H288.0L288.0 236.0H504.0L504.0 218.0H720.0L720.0 218.0H936.0");
}

TEST(SlowCommandPlot, ManyProbes) {
  const TemporaryFolder folder;
  const std::string in = folder / "a.exr", out = folder / "a.svg";
  Image invalid = studioProbe({64, 32});
  invalid.setRgb(3, 3, Rgb(std::nanf("")));
  const Image images[] = {constantProbe({1, 1}, Rgb(1)),     constantProbe({2, 1}, Rgb(1e-8f)),
                          spot(64, 32, 0, 16, 1e10f, 1e-8f), invalid,
                          spot(4096, 3, 2000, 1, 1, 0.1f),   spot(64, 32, 5, 0, 1, 0)};
  for (const Image& image : images) {
    writeImage(in, image);
    const CommandResult result = runCommand({"probe", "plot", in, out});
    EXPECT_EQ(result.status, 0) << result.error;
    const std::string svg = fileContents(out);
    EXPECT_NE(svg.find("16 samples"), std::string::npos);
    EXPECT_FALSE(hasInvalidNumber(svg));
    EXPECT_LT(svg.size(), 300000u);
  }
  writeImage(in, images[3]);
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--row", "31"},
                                             {"--row", "0", "--samples", "0"},
                                             {"--elevation", "-90", "--azimuth", "-30,30"},
                                             {"--elevation", "20", "--azimuth", "200,170"},
                                             {"--compensated", "--samples", "1000"}}) {
    std::vector<std::string> arguments{"probe", "plot", in, out};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(runCommand(arguments).status, 0) << options.front();
  }
}

TEST(SlowCommandPlot, BadInputIsRejected) {
  const TemporaryFolder folder;
  const std::string in = folder / "a.exr", out = folder / "a.svg";
  writeImage(in, spot(64, 32, 5, 2, 1, 0));
  const auto expect = [&](std::vector<std::string> options, const std::string& reason) {
    std::vector<std::string> arguments{"probe", "plot", in, out};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expectError(arguments, reason);
  };
  expect({"--row", "32"}, "--row: 32 should be 0 to 31");
  expect({"--row", "-1"}, "--row");
  expect({"--row", "4", "--elevation", "3"}, "--row");
  expect({"--elevation", "91"}, "--elevation");
  expect({"--elevation", "nan"}, "--elevation");
  expect({"--azimuth", "3"}, "--azimuth");
  expect({"--azimuth", "3,3"}, "--azimuth");
  expect({"--azimuth", "0,361"}, "--azimuth");
  expect({"--azimuth", "1e9,999999999"}, "--azimuth");
  expect({"--samples", "-1"}, "--samples");
  expect({"--samples", "10001"}, "--samples");
  expect({"--row", "20"}, "nothing is sampled in row 20");
  expect({"--row", "2", "--azimuth", "0,-20"}, "nothing is sampled between");
  expectError({"probe", "plot", in, folder / "a.png"}, ".svg");
  expectError({"probe", "plot", in, folder / "no/a.svg"}, "folder");
  writeImage(folder / "black.exr", constantProbe({2, 1}, Rgb(0)));
  const CommandResult black = runCommand({"probe", "plot", folder / "black.exr", out});
  EXPECT_EQ(black.status, 2);
  EXPECT_NE(black.error.find("nothing is sampled"), std::string::npos);
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "black.exr"}));
}

}  // namespace
}  // namespace chromeball::row_plot_test
