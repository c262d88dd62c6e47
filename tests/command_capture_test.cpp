// SPDX-License-Identifier: Apache-2.0
// chromeball probe merge, and probe sun: from photographs to a probe with its sun.
#include <gtest/gtest.h>

#include <fstream>

#include "base/json.h"
#include "bracket.h"
#include "exif_block.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "lighting/export/light_file.h"
#include "probe/edit.h"
#include "probe/irradiance.h"
#include "probe/mapping.h"
#include "probe/synth.h"
#include "run_command.h"
#include "shared_data.h"

namespace chromeball::command_capture_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class SlowCommandCapture : public testing::Test {
 protected:
  std::string write(const std::string& name, const Image& image) {
    writeImage(folder_ / name, image);
    return folder_ / name;
  }

  // An 8-bit photograph of the radiance at this exposure time, with its EXIF block.
  std::string photograph(const std::string& name, const Image& radiance, double factor,
                         const std::vector<ExifEntry>& exif) {
    Image exposure = radiance;
    for (float& texel : exposure.texels) texel *= float(factor);
    const std::string path = write(name, exposure);
    const std::string file = fileContents(path);
    if (!exif.empty()) std::ofstream(path, std::ios::binary) << withExif(file, exifBlock(exif));
    return path;
  }

  // Three photographs at f/2, of 1, 1/4 and 1/16 s.
  Words series(const Image& radiance) {
    Words files;
    for (uint32_t inverse : {1, 4, 16})
      files.push_back(photograph(fmt::format("{}.png", inverse), radiance, 0.25 / inverse,
                                 {exposureTime(1, inverse), fNumber(2, 1), isoSpeed(100)}));
    return files;
  }

  TemporaryFolder folder_;
  const Image radiance_ = ramp(64, 32, 0.05, 100);
  const std::string out_ = folder_ / "hdr.exr";
};

TEST_F(SlowCommandCapture, MergesByExif) {
  const Words merge = joined({"probe", "merge"}, series(radiance_));
  const CommandResult result = runCommand(joined(merge, {"-o", out_, "--json"}));
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(result.error, "");
  const json report = parseJson(result.out);
  ASSERT_EQ(report["exposures"].size(), 3u);
  EXPECT_EQ(report["exposures"][1]["time"], 0.25);
  EXPECT_EQ(report["exposures"][1]["aperture"], 2);
  EXPECT_EQ(report["exposures"][1]["factor"][0], 0.0625);
  EXPECT_EQ(report["response"], "srgb");
  EXPECT_NEAR(report["agreement"][0]["found_over_given"][1].get<double>(), 1, 0.01);
  const ImageFile file = readImageFile(out_);
  const Image merged = *findColor(file), clipped = *findLayer(file, "clipped");
  double count = 0, squares = 0, marked = 0;
  for (int y = 0; y < merged.height; ++y)
    for (int x = 0; x < merged.width; ++x) {
      marked += *clipped.at(x, y);
      if (*clipped.at(x, y) != 0) continue;
      for (int c = 0; c < 3; ++c, ++count)
        squares += std::pow(merged.at(x, y)[c] / radiance_.at(x, y)[c] - 1, 2);
    }
  EXPECT_LT(std::sqrt(squares / count), 0.01);
  EXPECT_GT(marked, 0);
  EXPECT_EQ(report["clipped_in_all"], marked);
  EXPECT_EQ(report["underexposed_in_all"], 0);
  const std::string text = runCommand(joined(merge, {"-o", out_})).out;
  EXPECT_NE(text.find("1/16 s, f/2, ISO 100, factor 0.01562"), std::string::npos) << text;
  EXPECT_NE(text.find("given 4, found "), std::string::npos) << text;
}

// Merges without EXIF, in any order, through a filter.
TEST_F(SlowCommandCapture, MergesByOptions) {
  const std::string longer = photograph("a.png", radiance_, 1. / 8, {}),
                    shorter = photograph("b.png", radiance_, 1. / 100, {});
  const Words merge = {"probe", "merge", shorter, longer, "-o", out_};
  const auto mergedWith = [&](const Words& options) {
    const CommandResult result = runCommand(joined(merge, options));
    EXPECT_EQ(result.status, 0) << result.error;
    EXPECT_EQ(result.error, "");
    return readImage(out_);
  };
  const Image plain = mergedWith({"--exposures", "1/100,1/8"});
  EXPECT_NEAR(plain.rgb(20, 20).x / radiance_.rgb(20, 20).x, 1, 0.02);
  EXPECT_EQ(mergedWith({"--exposures", "1/8,1/8", "--filter", "1=0.08,0.08,0.08"}).texels,
            plain.texels);
  EXPECT_EQ(mergedWith({"--exposures", "1/8,1/8", "--filter", "1=0.08"}).texels, plain.texels);
  EXPECT_EQ(
      mergedWith({"--exposures", "4,4", "--apertures", "20,8", "--aperture-ratio", "8:20=12.5"})
          .rgb(9, 9),
      2.f * plain.rgb(9, 9));
}

TEST_F(SlowCommandCapture, SolvesWritesAndReadsAResponse) {
  const Words files = series(ramp(256, 64, 0.05, 100));
  const std::string curve = folder_ / "curve.csv", again = folder_ / "again.exr";
  const CommandResult solved =
      runCommand(joined(joined({"probe", "merge"}, files),
                        {"--response", "solve", "--write-response", curve, "-o", out_}));
  EXPECT_EQ(solved.status, 0) << solved.error;
  EXPECT_EQ(solved.error, "");
  const CommandResult read =
      runCommand(joined(joined({"probe", "merge"}, files), {"--response", curve, "-o", again}));
  EXPECT_EQ(read.status, 0) << read.error;
  const Image a = readImage(out_), b = readImage(again);
  for (size_t i = 0; i < a.texels.size(); ++i)
    EXPECT_NEAR(b.texels[i], a.texels[i], 1e-5 * a.texels[i]);
}

TEST_F(SlowCommandCapture, WarnsOfExposuresThatDisagree) {
  const Words files = series(radiance_);
  const CommandResult result = runCommand(
      joined(joined({"probe", "merge"}, files), {"--exposures", "1,1/4,1/20", "-o", out_}));
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.error.find("16.png disagree by 2"), std::string::npos) << result.error;
  EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1) << result.error;
  const CommandResult unused =
      runCommand({"probe", "merge", files[0], write("white.png", constantProbe({64, 32}, Rgb(2))),
                  "--exposures", "1,10", "-o", out_});
  EXPECT_NE(unused.error.find("white.png: is not used"), std::string::npos) << unused.error;
}

TEST_F(SlowCommandCapture, CalibratesAFilter) {
  Image with = radiance_;
  multiply(with, Rgb(0.00105f, 0.00098f, 0.00091f));
  const CommandResult result = runCommand({"probe", "merge", "--calibrate-filter",
                                           write("with.exr", with), write("out.exr", radiance_)});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(result.error, "");
  EXPECT_EQ(result.out, "transmission    0.00105,0.00098,0.00091 of 2048 pixels\n");
}

TEST_F(SlowCommandCapture, BadSeriesAreRejected) {
  const Words files = series(radiance_);
  const auto expect = [&](const Words& words, const std::string& reason) {
    expectError(joined({"probe", "merge"}, words), reason);
  };
  const auto withOptions = [&](const Words& options) {
    return joined(joined(files, {"-o", out_}), options);
  };
  expect({}, "give the photographs");
  expect(files, "give -o");
  expect(joined(files, {"-o", folder_ / "a.png"}), "cannot hold the range");
  expect(joined(files, {"-o", files[0]}), "cannot hold the range");
  const std::string plain = write("plain.png", radiance_);
  expect({plain, "-o", out_},
         "plain.png: has no exposure time in an EXIF block; give the exposures");
  expect({files[0], write("none.exr", radiance_), "-o", out_}, "none.exr: has no exposure time");
  expect({files[0], photograph("iso.png", radiance_, 1, {exposureTime(1, 3), fNumber(2, 1)}), "-o",
          out_},
         "iso.png: has no ISO in its EXIF block, but ");
  expect({files[0], files[0], "-o", out_}, "the same exposure as all others");
  expect({files[0], write("small.png", ramp(8, 8, 1, 2)), "-o", out_, "--exposures", "1,2"},
         "small.png: is 8 x 8, but ");
  expect({files[0], write("floats.exr", radiance_), "-o", out_, "--exposures", "1,2"},
         "has floats, but ");
  const std::string noImage = folder_ / "text.jpg";
  std::ofstream(noImage) << "hello";
  expect({files[0], noImage, "-o", out_, "--exposures", "1,2"}, "text.jpg: cannot be read");
  expect({files[0], folder_ / "missing.jpg", "-o", out_}, "missing.jpg: no such file");
  const std::string white = write("white.png", constantProbe({8, 4}, Rgb(2))),
                    black = write("black.png", constantProbe({8, 4}, Rgb(0)));
  expect({white, white, "-o", out_, "--exposures", "1,2"}, "saturated in all exposures");
  expect({black, black, "-o", out_, "--exposures", "1,2"}, "black in all exposures");
  expect(withOptions({"--exposures", "1,2"}), "exposures: has 2 numbers for 3 photographs");
  expect(withOptions({"--exposures", "1,2,0"}), "`0` should be above 0");
  expect(withOptions({"--exposures", "1,2,1/0"}), "`1/0` should be above 0");
  expect(withOptions({"--exposures", "1,,2"}), "--exposures");
  expect(withOptions({"--exposures", "1,2,1e-30"}), "exposure factor 1e-30");
  expect(withOptions({"--aperture-ratio", "4=3"}), "as in 4:16=16.63");
  expect(withOptions({"--aperture-ratio", "2:16=16.63"}), "no photograph was taken at f/16");
  expect(withOptions({"--filter", "4=0.1"}), "1 to 3");
  expect(withOptions({"--filter", "1=0.1,0.2"}), "one number or three");
  expect(withOptions({"--flat-field", plain, "--flat-field", plain}), "more than one flat field");
  expect(withOptions({"--flat-field", "16=" + plain}), "no photograph was taken at f/16");
  expect(withOptions({"--flat-field", white}), "has the photographs' size");
  expect(withOptions({"--flat-field", write("zero.exr", Image(64, 32, 3))}), "above 0 everywhere");
  expect(withOptions({"--response", "sgrb"}), "`sgrb` is neither linear, srgb or solve nor a file");
  expect(withOptions({"--response", plain}), "is no response curve");
  expect(withOptions({"--response", "solve", "--smoothness", "-1"}), "`-1` should be above 0");
  for (const Words& options : {Words{}, {"--response", "linear"}})
    expect(joined(withOptions(options), {"--smoothness", "300"}),
           "--smoothness: has no effect without --response solve");
  expect(withOptions({"--white", "2"}), "integers of 8 bits, which are white at 1");
  expect(withOptions({"--calibrate-filter", plain, plain}), "give no photographs");
  expect({"--calibrate-filter", plain, white}, "two images of one view");
  for (const Words& options : {Words{"--exposures", "1,2"},
                               {"--apertures", "2,4"},
                               {"--aperture-ratio", "4:16=16.63"},
                               {"--filter", "1=0.1"},
                               {"--flat-field", plain},
                               {"--response", "linear"},
                               {"--write-response", folder_ / "curve.csv"},
                               {"--smoothness", "300"},
                               {"--white", "2"},
                               {"--resize"},
                               {"--unaligned"}})
    expect(joined({"--calibrate-filter", plain, plain}, options),
           options.front() + ": has no effect with --calibrate-filter");
  expect({"--calibrate-filter", black, black}, "no pixel is above 0");
  expect({write("a.exr", radiance_), write("b.exr", radiance_), "-o", out_, "--exposures", "1,2",
          "--response", "solve"},
         "no 8-bit levels");
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(SlowCommandCapture, ShiftedPhotographsAreRejected) {
  const auto texture = [](int dx) {
    Image image(128, 96, 3);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        image.setRgb(x, y, Rgb(float(std::exp(std::sin((x - dx) * 0.41) + std::cos(y * 0.37)))));
    return image;
  };
  const Words files = {photograph("a.png", texture(0), 0.3, {exposureTime(1, 3)}),
                       photograph("b.png", texture(4), 0.1, {exposureTime(1, 9)})};
  expectError(joined({"probe", "merge", "-o", out_}, files),
              "take them as they are; see --unaligned");
  EXPECT_EQ(runCommand(joined({"probe", "merge", "-o", out_, "--unaligned"}, files)).status, 0);
}

// The author cropped them to different sizes.
TEST_F(SlowCommandCapture, RealPhotographsOfDifferentSizesAreRejected) {
  const auto real = sharedData("reference/differential_rendering/kartikagrawal27/Materials");
  if (!real) GTEST_SKIP() << "no real photographs";
  const Words merge{"probe", "merge", *real / "10.JPG", *real / "40.JPG", *real / "160.JPG",
                    "-o",    out_};
  expectError(merge, "40.JPG: is 484 x 468, but ");
  expectError(merge, "are resized; see --resize");
  const CommandResult resized =
      runCommand(joined(merge, {"--resize", "--exposures", "1/10,1/40,1/160", "--unaligned"}));
  EXPECT_EQ(resized.status, 0) << resized.error;
  EXPECT_EQ(readImage(out_).width, 480);
}

TEST_F(SlowCommandCapture, CropsOfSeveralSizesAreResized) {
  const Image small = ramp(48, 24, 0.05, 100);
  const Words files{photograph("a.png", radiance_, 0.25, {}), photograph("b.png", small, 0.02, {})};
  const CommandResult result = runCommand(
      joined({"probe", "merge", "-o", out_, "--resize", "--exposures", "0.25,0.02"}, files));
  ASSERT_EQ(result.status, 0) << result.error;
  const ImageFile merged = readImageFile(out_);
  const Image color = *findColor(merged), clipped = *findLayer(merged, "clipped");
  ASSERT_EQ(color.width, 48);
  ASSERT_EQ(color.height, 24);
  // The ramps differ by a quarter of a pixel of the smaller one, a factor of 2000^(1 / 192) = 1.04;
  // levels of the darkest pixels are rounded by as much.
  for (int x = 4; x < 44; ++x)
    if (*clipped.at(x, 12) == 0) {
      EXPECT_NEAR(color.rgb(x, 12).x / small.rgb(x, 12).x, 1, 0.08) << x;
    }
}

// A sky whose sun the photographs clip, and a white ball in its full light, seen from +Z.
class SlowCommandSun : public SlowCommandCapture {
 protected:
  static constexpr double kRadius = 30;

  SlowCommandSun() {
    sky_ = clearSkyProbe({256, 128}, {.sunElevation = 40, .sunAzimuth = 150});
    Image clipped = sky_;
    clip(clipped, float(16 * luminance(meanRadiance(sky_))));
    write("clipped.exr", clipped);
    Image ball(64, 64, 3);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const dvec2 p((x + 0.5 - 32) / kRadius, (32 - y - 0.5) / kRadius);
        if (glm::length(p) >= 1) continue;
        const vec3 normal(p.x, p.y, std::sqrt(1 - glm::dot(p, p)));
        const dvec3 irradiance = exactIrradiance(sky_, std::span(&normal, 1)).front();
        ball.setRgb(x, y, Rgb(irradiance / kPiD * 0.5));
      }
    write("ball.exr", ball);
  }

  Words sun(const Words& options) {
    return joined({"probe", "sun", folder_ / "clipped.exr", "--diffuse", folder_ / "ball.exr",
                   "--circle", "32,32,30", "--paint", "0.5,0.5,0.5", "--camera", "0,0"},
                  options);
  }
  Image sky_;
};

TEST_F(SlowCommandSun, RestoresTheIrradianceOfTheSky) {
  const std::string full = folder_ / "full.exr", lights = folder_ / "sun.json";
  const CommandResult result =
      runCommand(sun({"-o", full, "--lights", lights, "--residual", folder_ / "r.exr", "--json"}));
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_EQ(result.error, "");
  const json report = parseJson(result.out);
  EXPECT_LT(report["rms"].get<double>(), 0.01);
  EXPECT_GT(report["rms_clipped"].get<double>(), 0.3);
  EXPECT_GT(report["explained"].get<double>(), 0.95);
  const Image restored = readImage(full);
  for (const vec3& normal : {vec3(0, 1, 0), vec3(0, 0, 1), vec3(-0.6f, 0, 0.8f)}) {
    const dvec3 truth = exactIrradiance(sky_, std::span(&normal, 1)).front();
    const dvec3 found = exactIrradiance(restored, std::span(&normal, 1)).front();
    EXPECT_LT(glm::distance(found / truth, dvec3(1)), 0.02);
  }
  const LightList list = readLights(lights);
  ASSERT_EQ(list.lights.size(), 1u);
  EXPECT_FLOAT_EQ(list.lights[0].angle, 0.53f);
  EXPECT_FLOAT_EQ(list.lights[0].irradiance.x, report["irradiance"][0].get<float>());
  EXPECT_EQ(readImage(folder_ / "r.exr").width, 61);
  EXPECT_EQ(runCommand(sun({"--residual", folder_ / "r.png"})).status, 0);
  EXPECT_NEAR(readImage(folder_ / "r.png", IntegerTexels::Linear).rgb(30, 30).x, 0.5, 0.05);
}

// The layer decides where the sun is; a mask leaves the result as it is, because all agrees.
TEST_F(SlowCommandSun, UsesLayerDirectionAndMask) {
  const auto irradiance = [&](const Words& words) {
    const CommandResult result = runCommand(joined(words, {"--json"}));
    EXPECT_EQ(result.status, 0) << result.error;
    return parseJson(result.out)["irradiance"][1].get<double>();
  };
  const double plain = irradiance(sun({}));
  Image mask(64, 64, 3);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 64; ++x) mask.setRgb(x, y, Rgb(1));
  EXPECT_NEAR(irradiance(sun({"--mask", write("mask.png", mask)})) / plain, 1, 0.01);
  const dvec3 d = sunDirection({.sunElevation = 40, .sunAzimuth = 150});
  const std::string direction = fmt::format("{},{},{}", d.x, d.y, d.z);
  EXPECT_NEAR(irradiance(sun({"--direction", direction})) / plain, 1, 0.02);

  Image clipped = readImage(folder_ / "clipped.exr"), marks(256, 128, 1);
  const dvec2 uv = directionToUv(Mapping::LatLong, d);
  *marks.at(int(uv.x * 256), int(uv.y * 128)) = 1;
  // Brighter than the sun, with little light, and not clipped.
  const float white = float(16 * luminance(meanRadiance(sky_)));
  clipped.setRgb(3, 20, Rgb(1.5f * white));
  const std::string marked = folder_ / "marked.exr";
  writeImage(marked, OutputImage{{{"", "RGB", clipped}, {"clipped", "", marks}}, {}, {}, {}});
  Words words = sun({"--json"});
  words[2] = marked;
  const CommandResult result = runCommand(words);
  ASSERT_EQ(result.status, 0) << result.error;
  const json found = parseJson(result.out);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found["direction"][size_t(c)].get<double>(), d[c], 0.03);
}

TEST_F(SlowCommandSun, WarnsOfAWidePlateau) {
  Image clipped = readImage(folder_ / "clipped.exr");
  clip(clipped, float(1.5 * luminance(meanRadiance(sky_))));
  write("clipped.exr", clipped);
  const CommandResult result = runCommand(sun({}));
  EXPECT_NE(result.error.find("degrees wide"), std::string::npos) << result.error;
}

TEST_F(SlowCommandSun, BadInputIsRejected) {
  const auto with = [&](size_t at, const std::string& value) {
    Words words = sun({});
    words[at] = value;
    return words;
  };
  expectError(with(2, folder_ / "none.exr"), "no such file");
  expectError(with(4, folder_ / "none.exr"), "no such file");
  expectError(with(6, "32,32,40"), "is not inside its 64 x 64 pixels");
  expectError(with(6, "32,32"), "--circle");
  expectError(with(6, "32,32,2"), "at least 8");
  expectError(with(8, "0.5,0,0.5"), "--paint");
  expectError(with(8, "0.5,1.5,0.5"), "--paint");
  expectError(with(8, "1,1,1"), "darker than the probe alone");
  expectError(with(10, "0,91"), "elevation");
  expectError(with(10, "0"), "--camera");
  expectError(sun({"--distance", "1"}), "--distance");
  expectError(sun({"--angle", "0"}), "--angle");
  expectError(sun({"--direction", "0,0,0"}), "--direction");
  expectError(sun({"--direction", "0,0,-1"}), "lights less than the rim");
  expectError(sun({"--lights", folder_ / "sun.csv"}), ".json");
  expectError(sun({"-o", folder_ / "clipped.exr"}), "would overwrite");
  expectError(sun({"--mask", write("small.png", Image(4, 4, 3))}),
              "a mask has the photograph's size");
  expectError(sun({"--mask", write("none.png", Image(64, 64, 3))}), "at least 100 are needed");
}

}  // namespace
}  // namespace chromeball::command_capture_test
