// SPDX-License-Identifier: Apache-2.0
// chromeball probe assemble, probe reflectivity and the photographs of probe convert.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/json.h"
#include "capture_photographs.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/convert.h"
#include "probe/load.h"
#include "probe/synth.h"
#include "run_command.h"
#include "shared_data.h"

namespace chromeball::command_assemble_test {
namespace {

using nlohmann::json;

constexpr ImageSize kSize{128, 64};
const Circle kCircle{{102.2, 98.6}, 80.3};

CommandResult run(const std::vector<std::string>& arguments) {
  CommandResult result = runCommand(arguments);
  EXPECT_EQ(result.status, 0) << result.error;
  return result;
}

Image studio() {
  return convert(studioProbe({512, 256}), Mapping::LatLong, Mapping::LatLong, {256, 128});
}

Image photograph(const Probe& probe, double azimuth) {
  return photographOf(BallScene{probe, 32, {azimuth, 0}, BallReflectance(dvec3(0.6)), 4, 0.1f}, 200,
                      200, kCircle);
}

// Two photographs; the second is exposed twice as long.
struct Photographs {
  TemporaryFolder folder;
  Image map = studio();
  std::string a = folder / "a.exr", b = folder / "b.exr", out = folder / "probe.exr";

  Photographs() {
    const Probe probe(map);
    writeImage(a, photograph(probe, 0));
    Image second = photograph(probe, 90);
    for (float& channel : second.texels) channel *= 2;
    writeImage(b, second);
  }
};

TEST(SlowCommandAssemble, TwoPhotographsReturnTheProbe) {
  const Photographs photographs;
  const std::string preview = photographs.folder / "preview.png";
  const CommandResult result =
      run({"probe", "assemble", photographs.a, photographs.b, "-o", photographs.out, "--azimuth",
           "0,91", "--distance", "32", "--reflectivity", "0.6", "--size", "256x128", "--preview",
           preview, "--json"});
  EXPECT_EQ(result.error.find("warning") != std::string::npos,
            result.error.find("the outline of the ball is doubtful") != std::string::npos)
      << result.error;
  const json report = parseJson(result.out);
  const json& second = report["views"][1];
  // A direction turns by 2 / radius for each pixel that a circle is beside its ball; both may be
  // off by 0.1 pixels.
  const double tolerance = 0.1 + 2 * glm::degrees(2 * 0.1 / kCircle.radius);
  EXPECT_NEAR(second["turn"], -1, tolerance) << result.out;
  EXPECT_NEAR(second["azimuth"], 90, tolerance);
  EXPECT_NEAR(second["gain"], 0.5, 0.005);
  EXPECT_EQ(report["blind_share"], 0);
  for (const json& view : report["views"]) {
    EXPECT_NEAR(view["circle"][0], kCircle.centre.x, 0.15);
    EXPECT_NEAR(view["circle"][1], kCircle.centre.y, 0.15);
    EXPECT_NEAR(view["circle"][2], kCircle.radius, 0.15);
    EXPECT_LT(view["circle_standard_error"], 0.4);
    EXPECT_GT(view["circle_support"], 0.4);
  }
  EXPECT_LT(irradianceError(readImage(photographs.out), photographs.map).mean, 0.01);
  const Image picture = readImage(preview);
  EXPECT_EQ(picture.width, 640);
  EXPECT_EQ(picture.height, 320 + 128);
}

TEST(SlowCommandAssemble, InOtherMappingsAndWithOtherFills) {
  const Photographs photographs;
  const std::string circle = "102.2,98.6,80.3";
  const CommandResult result = run({"probe", "assemble", photographs.a, "-o", photographs.out,
                                    "--circle", circle, "--reflectivity", "0.6", "--distance", "4",
                                    "--to", "angular", "--size", "100x100", "--fill", "7,8,9"});
  EXPECT_NE(result.out.find("angular"), std::string::npos);
  EXPECT_NE(result.out.find("blind"), std::string::npos);
  const Image angular = readImage(photographs.out);
  EXPECT_EQ(angular.width, 100);
  // The camera is on +Z: the blind direction -Z is in the centre.
  EXPECT_LT(glm::distance(angular.rgb(50, 50), Rgb(7, 8, 9)), 1e-4f);
  writeImage(photographs.folder / "fill.exr", constantProbe({8, 4}, Rgb(5)));
  run({"probe", "assemble", photographs.a, "-o", photographs.out, "--circle", circle, "--distance",
       "4", "--size", "64x32", "--fill", photographs.folder / "fill.exr"});
  EXPECT_EQ(readImage(photographs.out).rgb(32, 16), Rgb(5));
}

TEST(SlowCommandAssemble, WarnsOfWhatIsNotMeasured) {
  const Photographs photographs;
  const std::string png = photographs.folder / "a.png";
  writeImage(png, readImage(photographs.a));
  const CommandResult result =
      run({"probe", "assemble", png, "-o", photographs.out, "--circle", "102.2,98.6,80.3"});
  EXPECT_NE(result.error.find("integer texels"), std::string::npos);
  EXPECT_NE(result.error.find("no --reflectivity"), std::string::npos);
  const CommandResult cropped = run({"probe", "assemble", photographs.a, "-o", photographs.out,
                                     "--circle", "102,70,80", "--reflectivity", "0.6"});
  EXPECT_NE(cropped.error.find("outside the picture"), std::string::npos);
}

TEST(SlowCommandAssemble, Errors) {
  const Photographs p;
  const auto fails = [&](std::vector<std::string> more, const std::string& reason) {
    std::vector<std::string> all{"probe", "assemble", p.a, "-o", p.out};
    all.insert(all.end(), more.begin(), more.end());
    expectError(all, reason);
    EXPECT_FALSE(std::filesystem::exists(p.out));
  };
  fails({p.b}, "--azimuth: 2 photographs need the azimuths");
  fails({p.b, "--azimuth", "0"}, "--azimuth: 1 given for 2 photographs");
  fails({"--azimuth", "0:91"}, "elevation 91");
  fails({"--azimuth", "x"}, "`x` is not a number");
  fails({"--azimuth", "1e9"}, "-3600 to 3600");
  fails({"--circle", "1,2"}, "`1,2` is not 3 numbers");
  fails({"--circle", "100,100,3"}, "radius 3");
  fails({"--circle", "100,100,-30"}, "radius -30");
  fails({"--circle", "100,100,nan"}, "is not 3 numbers");
  fails({"--circle", "900,900,50"}, "is outside");
  fails({"--circle", "100,100,5000"}, "is outside");
  fails({"--circle", "100,100,50;100,100,50"}, "--circle: 2 given for 1 photograph;");
  fails({"--distance", "1"}, "--distance: 1 should be");
  fails({"--reflectivity", "0"}, "--reflectivity: 0 should be");
  fails({"--reflectivity", "1,2,3"}, "--reflectivity: 2 should be");
  fails({"--reflectivity", "1,1"}, "is not 3 numbers");
  fails({"--ball-ior", "0,0"}, "--ball-ior: 0,0 should be");
  fails({"--ball-ior", "1,0"}, "--ball-ior: 1,0 should be");
  fails({"--schlick"}, "--schlick: needs --reflectivity");
  fails({"--camera-disc", "91"}, "--camera-disc: 91");
  fails({"--from", "angular"}, "--probe-mapping: `angular` should be");
  fails({"--from", "fisheye:400"}, "field of view `400`");
  fails({"--from", "fisheye:180:equi"}, "unknown projection `equi`");
  fails({"--from", "fisheye", "--distance", "32"}, "--distance: is for mirror balls");
  fails({"--to", "nowhere"}, "--to: `nowhere` should be");
  fails({"--to", "angular", "--size", "100x50"}, "--to: an image of 100 x 50");
  fails({"--size", "0x0"}, "--size: `0x0`");
  fails({"--fill", "grey"}, "--fill: `grey` should be");
  fails({"--fill", "1,-1,1"}, "--fill: -1 should be");
  fails({"--preview", p.folder / "p.exr"}, ".png");
  fails({"--preview", "/nowhere/p.png"}, "/nowhere");
  fails({p.folder / "missing.exr", "--azimuth", "0,90"}, "missing.exr");
  writeImage(p.folder / "small.png", constantProbe({8, 8}, Rgb(1)));
  fails({"--mask", p.folder / "small.png"}, "8 x 8 texels should be 200 x 200");
  writeImage(p.folder / "black.png", constantProbe({200, 200}, Rgb(0)));
  fails({"--mask", p.folder / "black.png"}, "leave no direction");
  fails({"--mask", p.folder / "black.png", "--mask", p.folder / "black.png"},
        "--mask: 2 given for 1 photograph;");
  std::vector<std::string> many(16, p.b);
  fails(many, "17 photographs are too many; at most 16");
  writeImage(p.folder / "even.exr", constantProbe({200, 100}, Rgb(1)));
  expectError({"probe", "assemble", p.folder / "even.exr", "-o", p.out}, "no ball found");
  expectError({"probe", "assemble", p.folder / "even.exr", "-o", p.out, "--from", "fisheye"},
              "no image circle found");
  expectError({"probe", "assemble", p.a, "-o", p.a}, "a.exr");
  expectError({"probe", "assemble", p.a, "-o", p.folder / "x.jpg"}, "x.jpg");
  expectError({"probe", "assemble", p.a}, "--output");
}

TEST(SlowCommandAssemble, FisheyePhotographs) {
  const TemporaryFolder folder;
  const Image map = studio();
  const std::string front = folder / "front.exr", back = folder / "back.exr";
  writeImage(front, convert(map, Mapping::LatLong, Fisheye{200}, {300, 300}));
  writeImage(back, convert(map, Mapping::LatLong, Fisheye{200}, {300, 300}, 180));
  const json report =
      parseJson(run({"probe", "assemble", front, back, "-o", folder / "probe.exr", "--from",
                     "fisheye:200", "--azimuth", "0,180", "--size", "256x128", "--json"})
                    .out);
  EXPECT_EQ(report["blind_share"], 0);
  EXPECT_LT(irradianceError(readImage(folder / "probe.exr"), map).mean, 0.003);
}

// A square sensor may be larger than the image circle.
TEST(SlowCommandAssemble, FindsTheImageCircleInASquarePicture) {
  const TemporaryFolder folder;
  const Image map = studio(), whole = convert(map, Mapping::LatLong, Fisheye{180}, {240, 240});
  Image square(300, 300, 3);
  for (int y = 0; y < whole.height; ++y)
    for (int x = 0; x < whole.width; ++x)
      if (std::hypot(x - 119.5, y - 119.5) < 120) square.setRgb(x + 22, y + 37, whole.rgb(x, y));
  writeImage(folder / "square.exr", square);
  for (const std::vector<std::string>& circle :
       {std::vector<std::string>{}, std::vector<std::string>{"--circle", "auto"}}) {
    std::vector<std::string> words{
        "probe",   "assemble", folder / "square.exr", "-o", folder / "probe.exr", "--from",
        "fisheye", "--json"};
    words.insert(words.end(), circle.begin(), circle.end());
    const json found = parseJson(run(words).out)["views"][0]["circle"];
    EXPECT_NEAR(double(found[0]), 142, 0.3);
    EXPECT_NEAR(double(found[1]), 157, 0.3);
    EXPECT_NEAR(double(found[2]), 120, 0.3);
  }
}

// The pictures that `probe convert` writes: the circle fills them, and lights the pixels that it
// cuts as a whole, so that their outline is another one.
TEST(SlowCommandAssemble, PicturesOfProgramsAreCutToTheirCircle) {
  const TemporaryFolder folder;
  writeImage(folder / "map.exr", studio());
  using Words = std::vector<std::string>;
  for (const std::string mapping : {"fisheye", "mirror-ball"}) {
    Words conversion{"probe", "convert", folder / "map.exr", folder / "p.exr",
                     "--to",  mapping,   "--size",           "128x128"};
    if (mapping == "mirror-ball") conversion.push_back("--flip");
    run(conversion);
    const auto assembled = [&](Words more) {
      Words words{"probe", "assemble", folder / "p.exr", "-o", folder / "o.exr", "--size", "32x16"};
      if (mapping == "fisheye") words.insert(words.end(), {"--from", "fisheye"});
      words.insert(words.end(), more.begin(), more.end());
      run(words);
      return readImage(folder / "o.exr").texels;
    };
    EXPECT_EQ(assembled({}), assembled({"--circle", "64,64,64"})) << mapping;
  }
}

// A lens that looks up has its camera below: elevation -90. With the other sign the sky would be
// below the horizon.
TEST(SlowCommandAssemble, WarnsOfAProbeThatIsUpsideDown) {
  const TemporaryFolder folder;
  const std::string sky = folder / "sky.exr", ground = folder / "ground.exr";
  writeImage(sky, constantProbe({100, 100}, Rgb(4)));
  writeImage(ground, constantProbe({100, 100}, Rgb(0.5f)));
  const auto error = [&](std::vector<std::string> photographs, const std::string& azimuths) {
    photographs.insert(photographs.begin(), {"probe", "assemble"});
    photographs.insert(photographs.end(),
                       {"-o", folder / "probe.exr", "--from", "fisheye", "--azimuth", azimuths,
                        "--size", "32x16", "--keep-exposure", "--keep-azimuth"});
    return run(photographs).error;
  };
  EXPECT_NE(error({sky}, "0:90").find("looks below the horizon"), std::string::npos);
  EXPECT_EQ(error({sky}, "0:-90"), "");
  EXPECT_EQ(error({sky, ground}, "0:-90,0:90"), "");
  EXPECT_NE(error({sky, ground}, "0:90,0:-90").find("as bright below the horizon"),
            std::string::npos);
  EXPECT_EQ(error({sky}, "0"), "");
}

// The output file names its mapping.
TEST(SlowCommandAssemble, NamesTheMappingOfItsOutput) {
  const Photographs photographs;
  run({"probe", "assemble", photographs.a, "-o", photographs.out, "--circle", "102.2,98.6,80.3",
       "--reflectivity", "0.6", "--distance", "32", "--to", "angular", "--size", "64x64"});
  EXPECT_EQ(loadProbe(photographs.out).mapping, Mapping(Mapping::AngularMap));
  EXPECT_NE(run({"probe", "assemble", photographs.a, "-o", photographs.out, "--circle",
                 "102.2,98.6,80.3", "--reflectivity", "0.6"})
                .error.find("no --distance"),
            std::string::npos);
}

// The messages of `probe convert` about photographs, and how it flips them.
TEST(SlowCommandConvert, FlipsPhotographs) {
  const Photographs p;
  const Image ball = convert(p.map, Mapping::LatLong, Mapping::MirrorBall, {200, 200});
  const std::string file = p.folder / "ball.exr";
  writeImage(file, ball);
  const auto convertBall = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"probe",       "convert", file,       p.out,    "--from",
                                 "mirror-ball", "--to",    "lat-long", "--size", "128x64"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all).error;
  };
  EXPECT_NE(convertBall({}).find("use --flip, or `probe assemble`"), std::string::npos);
  const Image plain = readImage(p.out);
  EXPECT_EQ(convertBall({"--flip"}), "");
  const Image flipped = readImage(p.out);
  Image mirrored = ball;
  for (int y = 0; y < ball.height; ++y)
    for (int x = 0; x < ball.width; ++x) mirrored.setRgb(x, y, ball.rgb(ball.width - 1 - x, y));
  writeImage(file, mirrored);
  convertBall({});
  const Image expected = readImage(p.out);
  // Rounding of the directions moves the interpolation beside bright texels.
  const float tolerance = 2e-6f * *std::ranges::max_element(plain.texels);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x) {
      const Rgb one = flipped.rgb(x, y), other = plain.rgb(127 - x, y);
      EXPECT_LE(maxComponent(absolute(one - other)), tolerance);
      ASSERT_LT(glm::distance(flipped.rgb(x, y), expected.rgb(x, y)), 1e-4f);
    }
}

TEST(SlowCommandConvert, ReadsAndWritesFisheyes) {
  const TemporaryFolder folder;
  const std::string map = folder / "map.exr", disc = folder / "disc.exr";
  writeImage(map, studio());
  run({"probe", "convert", map, disc, "--to", "fisheye:200:equisolid"});
  const json info =
      parseJson(run({"probe", "info", disc, "--json", "--mapping", "fisheye:200:equisolid"}).out);
  EXPECT_EQ(info["mapping"], "fisheye:200:equisolid");
  const CommandResult back = run({"probe", "convert", disc, folder / "back.exr", "--from",
                                  "fisheye:200:equisolid", "--to", "lat-long"});
  EXPECT_NE(back.error.find("shows 58.7% of the sphere"), std::string::npos) << back.error;
  expectError({"probe", "convert", map, disc, "--to", "fisheye:20"},
              "--to: the field of view `20`");
  expectError({"probe", "convert", map, disc, "--from", "fisheye", "--to", "lat-long"},
              "--probe-mapping: an image of 256 x 128 texels cannot be fisheye");
}

TEST(SlowCommandReflectivity, PrintsThatOfABall) {
  const TemporaryFolder folder;
  Image image = constantProbe({40, 20}, Rgb(2, 3, 4));
  for (int y = 0; y < 20; ++y)
    for (int x = 20; x < 40; ++x) image.setRgb(x, y, Rgb(0.59f) * image.rgb(x, y));
  const std::string photograph = folder / "a.exr", standard = folder / "standard.exr";
  writeImage(photograph, image);
  writeImage(standard, constantProbe({10, 10}, Rgb(4, 6, 8)));
  const std::vector<std::string> command{"probe", "reflectivity", photograph, "--reflected",
                                         "22,2,10,10"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = command;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  EXPECT_NE(run(with({"--direct", "2,2,10,10"})).out.find("59% reflective"), std::string::npos);
  const json ball = parseJson(run(with({"--direct", "2,2,10,10", "--json"})).out);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(ball["reflectivity"][c], 0.59, 1e-6);
    EXPECT_NEAR(ball["standard_error"][c], 0, 1e-6);
  }
  const json paint = parseJson(
      run(with({"--against", "2,2,10,10", "--standard-reflectance", ".9", "--json"})).out);
  EXPECT_NEAR(paint["reflectivity"][1], 0.9 * 0.59, 1e-6);
  const json other = parseJson(run(with({"--against", standard, "--direct", "0,0,10,10",
                                         "--standard-reflectance", "0.9,0.8,0.7", "--json"}))
                                   .out);
  EXPECT_NEAR(other["reflectivity"][2], 0.5 * 0.7 * 0.59, 1e-6);

  expectError(command, "--direct: give the rectangle");
  expectError(with({"--direct", "35,2,10,10"}), "--direct: 35,2,10,10 reaches outside");
  expectError(with({"--direct", "1,2,3"}), "should be X,Y,WIDTH,HEIGHT");
  expectError(with({"--direct", "2,2,5,5", "--against", "2,2,5,5"}), "takes the place of --direct");
  expectError(with({"--direct", "2,2,5,5", "--standard-reflectance", "2"}), "2 should be above 0");
  expectError(with({"--direct", "2,2,5,5", "--saturation", "3"}), "saturated");
  expectError(with({"--direct", "2,2,5,5", "--saturation", "0"}), "--saturation: 0");
  expectError(with({"--direct", "2,2,5,5", "--against", folder / "no.exr"}), "no.exr");
  expectError({"probe", "reflectivity", photograph, "--direct", "2,2,5,5"}, "--reflected");
}

// The office's ball against the map that its photographer made from it: that map has its camera,
// which we put on +Z, in the centre, where ours has -Z.
TEST(SlowCommandAssemble, RealBallAgreesWithItsAuthorsMap) {
  const std::string at = "reference/differential_rendering/bbold72_cs445_samples/";
  const auto ball = sharedData(at + "calib_hdr.hdr"),
             theirs = sharedData(at + "equirectangular.hdr");
  if (!ball || !theirs) GTEST_SKIP() << "no shared data";
  const TemporaryFolder folder;
  const Image expected = readImage(*theirs);
  const auto measured = [&](const std::vector<std::string>& arguments) {
    run(arguments);
    const Image ours = readImage(folder / "ours.exr");
    double squares = 0, mean = 0;
    std::vector<double> relative;
    for (int y = 0; y < expected.height; ++y)
      for (int x = 0; x < expected.width; ++x) {
        const Rgb a = ours.rgb((x + expected.width / 2) % expected.width, y),
                  b = expected.rgb(x, y);
        const dvec3 d(a - b);
        squares += glm::dot(d, d) / 3;
        mean += (double(b.x) + double(b.y) + double(b.z)) / 3;
        const double theirMean = (double(b.x) + double(b.y) + double(b.z)) / 3;
        if (theirMean > 0) relative.push_back(std::fabs(d.x + d.y + d.z) / 3 / theirMean);
      }
    std::nth_element(relative.begin(), relative.begin() + ptrdiff_t(relative.size() / 2),
                     relative.end());
    const double count = double(expected.width) * expected.height;
    return std::pair{std::sqrt(squares / count) / (mean / count), relative[relative.size() / 2]};
  };
  const auto [rms, median] =
      measured({"probe", "assemble", ball->string(), "-o", folder / "ours.exr", "--circle",
                "190.5,190.5,190.5", "--size", "720x360"});
  // The maps differ in interpolation, and at the rim, where theirs reads pixels beside the ball.
  EXPECT_LT(rms, 0.053);
  EXPECT_LT(median, 0.0067);
  // The same photograph read as an ideal mirror ball, without a flip.
  const double unflipped =
      measured({"probe", "convert", ball->string(), folder / "ours.exr", "--from", "mirror-ball",
                "--to", "lat-long", "--size", "720x360", "--rotation", "180"})
          .first;
  EXPECT_NEAR(unflipped, 0.38, 0.02);
}

}  // namespace
}  // namespace chromeball::command_assemble_test
