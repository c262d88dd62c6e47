// SPDX-License-Identifier: Apache-2.0
// Loading probes from files, their warnings and statistics.
#include <gtest/gtest.h>

#include "base/error.h"
#include "image/io/write_image.h"
#include "instrumented.h"
#include "math/icosphere.h"
#include "probe/convert.h"
#include "probe/info.h"
#include "probe/load.h"
#include "probe/mapping.h"
#include "probe/probe.h"
#include "probe/synth.h"
#include "run_command.h"
#include "shared_data.h"

namespace chromeball::probe_file_test {
namespace {

TEST(ProbeFile, LatLongOfAnyShapeIsNotResampled) {
  const TemporaryFolder folder;
  for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {3, 2}, {1, 2}, {5, 5}, {64, 32}}) {
    const Image image = gradientProbe({w, h}, Rgb(1, 2, 3), {0.2, 0.3, 0.4});
    writeImage(folder / "p.exr", image);
    const LoadedProbe probe = loadProbe(folder / "p.exr");
    EXPECT_EQ(probe.latLong.texels, image.texels) << w << " x " << h;
    EXPECT_TRUE(probe.detected);
    EXPECT_FALSE(probe.reason.empty());
  }
}

TEST(ProbeFile, GivenMappingOverridesDetection) {
  const TemporaryFolder folder;
  writeImage(folder / "p.exr", constantProbe({32, 32}, Rgb(1)));
  const LoadedProbe latLong = loadProbe(folder / "p.exr", "lat-long");
  EXPECT_EQ(latLong.latLong.width, 32);
  EXPECT_FALSE(latLong.detected);
  const LoadedProbe ball = loadProbe(folder / "p.exr", "mirror-ball");
  EXPECT_EQ(ball.latLong.width, 2 * ball.latLong.height);
  EXPECT_THROW(loadProbe(folder / "p.exr", "cube-cross"), InputError);
  EXPECT_THROW(loadProbe(folder / "p.exr", "sphere"), InputError);
}

// A mirror ball and an angular map look alike: a file of this program states which it is.
TEST(ProbeFile, ConvertedProbesNameTheirMapping) {
  const TemporaryFolder folder;
  const Image sky = gradientProbe({64, 32}, Rgb(1, 2, 3), {0.2, 0.3, 0.4});
  writeImage(folder / "sky.exr", sky);
  for (const char* name : {"converted.exr", "converted.hdr"})
    for (const char* mapping : {"mirror-ball", "angular", "fisheye:360:equisolid", "cube-3x2",
                                "cube-cross", "cube-strip", "lat-long"}) {
      const std::string path = folder / name;
      const CommandResult result =
          runCommand({"probe", "convert", folder / "sky.exr", path, "--to", mapping});
      ASSERT_EQ(result.status, 0);
      EXPECT_EQ(result.error.find("has no place"), std::string::npos);
      const LoadedProbe probe = loadProbe(path);
      EXPECT_EQ(mappingName(probe.mapping), mapping);
      EXPECT_EQ(probe.reason, "the file names it");
    }
  // Mappings named by other programs, or for another image.
  for (const char* text : {"uv", "mirror-ball", ""}) {
    writeImage(folder / "other.exr", OutputImage{{{"", "RGB", sky}}, {{"mapping", text}}});
    EXPECT_EQ(loadProbe(folder / "other.exr").mapping, Mapping(Mapping::LatLong));
  }
}

// A file without a place for the mapping is read with the one that shape and corners suggest.
TEST(ProbeFile, ConvertWarnsOfALostMapping) {
  const TemporaryFolder folder;
  writeImage(folder / "sky.exr", gradientProbe({64, 32}, Rgb(0.1f, 0.2f, 0.3f), {0.2, 0.3, 0.4}));
  const auto warns = [&](const char* name, const char* mapping, const char* size) {
    const CommandResult result = runCommand(
        {"probe", "convert", folder / "sky.exr", folder / name, "--to", mapping, "--size", size});
    EXPECT_EQ(result.status, 0);
    const bool namesScene = result.error.find("[probe] mapping") != std::string::npos;
    EXPECT_FALSE(namesScene && std::string_view(mapping) == "fisheye");  // refused there
    return result.error.find("has no place for its mapping") != std::string::npos;
  };
  for (const char* name : {"p.pfm", "p.png"}) {
    EXPECT_TRUE(warns(name, "mirror-ball", "256x256"));
    EXPECT_TRUE(warns(name, "fisheye", "256x256"));
    EXPECT_TRUE(warns(name, "lat-long", "256x256"));
    EXPECT_FALSE(warns(name, "angular", "256x256"));
    EXPECT_FALSE(warns(name, "lat-long", "256x128"));
    EXPECT_FALSE(warns(name, "cube-cross", "192x256"));
  }
}

// A picture of 60 degrees becomes a map of 0.4 GB, of which loading takes three copies.
TEST(ProbeFile, TheMemoryOfItsMapIsChecked) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  const TemporaryFolder folder;
  writeImage(folder / "p.exr",
             OutputImage{{{"", "RGB", constantProbe({1366, 1366}, Rgb(1))}},
                         {{kMappingAttribute, std::string("fisheye:60:equidistant")}}});
  const CommandResult result =
      runExecutable({"probe", "info", folder / "p.exr"}, "", SIGINT, {.memory = size_t(1) << 30});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.error.find("x 4098 texels with 3 channels take"), std::string::npos)
      << result.error;
}

TEST(ProbeFile, AMappingThatIsNotUsedIsNamed) {
  const TemporaryFolder folder;
  for (const auto& [name, isUsed] :
       {std::pair("angular", true), {"ANGULAR", false}, {"cube-cross", false}}) {
    writeImage(folder / "p.exr", OutputImage{{{"", "RGB", constantProbe({32, 32}, Rgb(1))}},
                                             {{kMappingAttribute, std::string(name)}}});
    const std::string said = runCommand({"probe", "info", folder / "p.exr"}).error;
    EXPECT_EQ(said.find(fmt::format("its `mapping`, {}, is unknown", name)) == std::string::npos,
              isUsed)
        << said;
  }
}

TEST(ProbeFile, InvalidTexelsAreRepairedAndReported) {
  const TemporaryFolder folder;
  Image image = constantProbe({16, 8}, Rgb(1));
  image.setRgb(4, 3, Rgb(std::nanf("")));
  image.setRgb(5, 6, Rgb(-1));
  writeImage(folder / "p.exr", image);
  const LoadedProbe probe = loadProbe(folder / "p.exr");
  EXPECT_EQ(probe.repair.nan, 1u);
  EXPECT_EQ(probe.repair.negative, 1u);
  EXPECT_EQ(probe.latLong.rgb(4, 3), Rgb(1));
  const std::vector<std::string> lines = warnings(probe, "p.exr");
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("(4, 3)"), std::string::npos) << lines[0];
}

void writeEnvironment(const std::string& path, const Image& image, const char* envmap) {
  writeImage(path, OutputImage{{{"", "RGB", image}}, {{kEnvmapAttribute, std::string(envmap)}}});
}

// The same environment as a cube and as a lat-long map, both in OpenEXR's convention. Its radiance
// is a linear function of direction, which differs for every orientation.
TEST(ProbeFile, OpenExrCubeAndLatLongMapsAgree) {
  const TemporaryFolder folder;
  const dvec3 slope(0.3, 0.2, -0.4);
  const Image ours = gradientProbe({64, 32}, Rgb(1), slope);
  // In OpenEXR's lat-long maps, the centre is +Z and +X is a quarter of the width from the left.
  writeEnvironment(folder / "even.exr", gradientProbe({64, 32}, Rgb(1), {-0.3, 0.2, 0.4}),
                   kEnvmapLatLong);
  writeEnvironment(folder / "odd.exr", gradientProbe({63, 32}, Rgb(1), {-0.3, 0.2, 0.4}),
                   kEnvmapLatLong);
  writeEnvironment(folder / "cube.exr",
                   convert(ours, Mapping::LatLong, Mapping::VerticalStrip, {32, 192}), kEnvmapCube);
  writeImage(folder / "plain.exr", ours);
  for (const char* name : {"even.exr", "odd.exr", "cube.exr", "plain.exr"}) {
    const LoadedProbe loaded = loadProbe(folder / name);
    const bool hasAttribute = std::string(name) == "even.exr" || std::string(name) == "odd.exr";
    EXPECT_EQ(loaded.turned, hasAttribute) << name;
    EXPECT_EQ(warnings(loaded, name).size(), hasAttribute ? 1u : 0u) << name;
    const Probe probe(loaded.latLong);
    for (const vec3& d :
         {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 0, 1), vec3(0, 0, -1), vec3(0.6f, 0.64f, 0.48f)})
      EXPECT_NEAR(probe.radiance(d).x, 1 + glm::dot(slope, dvec3(d)), 0.02) << name;
  }
  // The attribute is used even if the mapping is given.
  EXPECT_TRUE(loadProbe(folder / "even.exr", "lat-long").turned);
}

TEST(ProbeFile, RealOpenExrEnvironmentMapsAgree) {
  const auto folder = sharedData("probes/openexr");
  if (!folder) GTEST_SKIP() << "no probes/openexr";
  for (const std::string name : {"Orientation", "StageEnv"}) {
    const Probe cube(loadProbe(*folder / (name + "Cube.exr")).latLong);
    const Probe latLong(loadProbe(*folder / (name + "LatLong.exr")).latLong);
    double agree = 0, turned = 0;  // sums of absolute differences of clipped radiance
    for (const vec3& d : icosphereNormals(4)) {
      const auto shown = [](const Probe& probe, const vec3& to) {
        return glm::min(probe.radiance(to), Rgb(1));
      };
      const Rgb seen = shown(cube, d);
      agree += luminance(glm::abs(seen - shown(latLong, d)));
      turned += luminance(glm::abs(seen - shown(latLong, {-d.x, d.y, -d.z})));
    }
    EXPECT_LT(agree, 0.5 * turned) << name;
  }
}

TEST(ProbeFile, ClippedLightIsReported) {
  const TemporaryFolder folder;
  Image image = gradientProbe({64, 32}, Rgb(1), {0.2, 0.6, 0.3});
  const auto messages = [&](const char* name, const Image& probe) {
    writeImage(folder / name, probe);
    std::string all;
    for (const std::string& line : warnings(loadProbe(folder / name), name)) all += line;
    return all;
  };
  EXPECT_EQ(messages("a.exr", image), "");
  EXPECT_EQ(messages("constant.exr", constantProbe({64, 32}, Rgb(1))), "");
  EXPECT_NE(messages("a.png", image).find("radiance above 1 was clipped"), std::string::npos);
  EXPECT_NE(messages("black.exr", constantProbe({64, 32}, Rgb(0))).find("is black"),
            std::string::npos);
  for (float& x : image.texels) x = std::min(x, 1.0f);
  EXPECT_NE(messages("clipped.exr", image).find("have the maximum value, 1:"), std::string::npos);
  EXPECT_GT(loadProbe(folder / "clipped.exr").fractionAtMaximum, 0.2);
}

// Equally bright texels at the equator and at the poles, where texels have small solid angles.
TEST(ProbeInfo, SetsOfBrightestTexelsAreNested) {
  Image image = constantProbe({64, 32}, Rgb(1e-3f));
  for (int x = 0; x < 64; ++x) image.setRgb(x, 0, Rgb(5)), image.setRgb(x, 31, Rgb(5));
  for (const int x : {0, 63}) image.setRgb(x, 16, Rgb(5));
  const ProbeInfo info = probeInfo(image);
  ASSERT_GE(info.brightestTexels.size(), 3u);
  for (size_t i = 1; i < info.brightestTexels.size(); ++i) {
    EXPECT_GT(info.brightestTexels[i].count, info.brightestTexels[i - 1].count);
    EXPECT_GT(info.brightestTexels[i].fraction, info.brightestTexels[i - 1].fraction);
  }
  EXPECT_NEAR(info.brightestTexels[0].fraction,
              5 * texelSolidAngle(16, 64, 32) / (4 * kPiD * luminance(Rgb(info.meanRadiance))),
              1e-6);
}

TEST(ProbeInfo, OneTexel) {
  const int w = 64, h = 32;
  const ProbeInfo info = probeInfo(oneHotProbe({w, h}, 40, 9, Rgb(1000, 2000, 500)));
  const double solidAngle = texelSolidAngle(9, w, h);
  EXPECT_NEAR(info.meanRadiance.y, 2000 * solidAngle / (4 * kPiD), 1e-9);
  EXPECT_EQ(info.max, Rgb(1000, 2000, 500));
  EXPECT_EQ(info.min, Rgb(0));
  EXPECT_EQ(info.brightestTexels.front().fraction, 1);
  ASSERT_EQ(info.suns.size(), 1u);
  EXPECT_NEAR(info.suns[0].irradiance.x / (1000 * solidAngle), 1, 1e-3);
  EXPECT_LT(glm::distance(info.suns[0].direction, info.brightestDirection), 1e-3);
  // The disc has about the solid angle of the texel.
  EXPECT_NEAR(info.suns[0].angle / (std::sqrt(4 / kPiD * solidAngle) * 180 / kPiD), 1, 0.05);
}

TEST(ProbeInfo, ConstantAndBlack) {
  const ProbeInfo constant = probeInfo(constantProbe({30, 20}, Rgb(0.5f)));
  EXPECT_NEAR(constant.meanRadiance.z, 0.5, 1e-12);
  EXPECT_NEAR(constant.dynamicRange, 1, 1e-6);
  EXPECT_TRUE(constant.suns.empty());
  const ProbeInfo black = probeInfo(constantProbe({30, 20}, Rgb(0)));
  EXPECT_EQ(black.dynamicRange, 0);
  EXPECT_EQ(black.brightestTexels.front().fraction, 0);
  EXPECT_TRUE(black.suns.empty());
}

}  // namespace
}  // namespace chromeball::probe_file_test
