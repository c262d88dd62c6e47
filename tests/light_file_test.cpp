// SPDX-License-Identifier: Apache-2.0
// Files of directional lights, and their error of irradiance (Madsen and Laursen 2007).
#include "lighting/export/light_file.h"
#include "base/json.h"
#include "json_file.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "lighting/fit/light_descent.h"
#include "math/icosphere.h"
#include "run_command.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball::light_file_test {
namespace {

using nlohmann::json;

LightRig exampleRig() {
  LightRig rig{"a \"probe\".hdr", "median-cut", Rgb(0.1f, 0.2f, 0.3f), {}};
  rig.lights.push_back({normalize(vec3(1, 2, -3)), Rgb(5, 2, 1), 0});
  rig.lights.push_back({vec3(0, 0, -1), Rgb(0, 0.25f, 1 / 3.0f), 0.53f});
  rig.lights.push_back({vec3(0, 0, 1), Rgb(0), 0});
  rig.lights.push_back({vec3(0, -1, 0), Rgb(1e-9f, 1e20f, 3), 2});
  return rig;
}

vec3 triple(const json& numbers) {
  EXPECT_EQ(numbers.size(), 3u);
  return {numbers[0].get<float>(), numbers[1].get<float>(), numbers[2].get<float>()};
}

TEST(LightFile, JsonKeepsEveryDigit) {
  const TemporaryFolder folder;
  const LightRig rig = exampleRig();
  writeLights(folder / "a.json", rig);
  const json read = jsonOfFile(folder / "a.json");
  EXPECT_EQ(read["probe"], rig.probe);
  EXPECT_EQ(read["method"], rig.method);
  EXPECT_EQ(triple(read["ambient"]), rig.ambient);
  ASSERT_EQ(read["lights"].size(), rig.lights.size());
  for (size_t i = 0; i < rig.lights.size(); ++i) {
    const json& light = read["lights"][i];
    EXPECT_EQ(triple(light["direction"]), rig.lights[i].direction);
    EXPECT_EQ(triple(light["irradiance"]), rig.lights[i].irradiance);
    EXPECT_EQ(light["angle"].get<float>(), rig.lights[i].angle);
  }
  writeLights(folder / "empty.json", {"p", "m", {}, {}});
  const json empty = jsonOfFile(folder / "empty.json");
  EXPECT_FALSE(empty.contains("ambient"));
  EXPECT_EQ(empty["lights"], json::array());
}

// Rotates (0, 0, -1) by the quaternion x, y, z, w.
dvec3 lightGoes(const json& q) {
  return glm::dquat(q[3].get<double>(), q[0].get<double>(), q[1].get<double>(),
                    q[2].get<double>()) *
         dvec3(0, 0, -1);
}

TEST(LightFile, GltfNodesPointFromTheLightToTheScene) {
  const TemporaryFolder folder;
  const LightRig rig = exampleRig();
  writeLights(folder / "a.gltf", rig);
  const json gltf = jsonOfFile(folder / "a.gltf");
  EXPECT_EQ(gltf["asset"]["version"], "2.0");
  EXPECT_EQ(gltf["extensionsUsed"], json({"KHR_lights_punctual"}));
  EXPECT_EQ(gltf["scenes"][0]["nodes"], json({0, 1, 2, 3}));
  for (size_t i = 0; i < rig.lights.size(); ++i) {
    const json& node = gltf["nodes"][i];
    EXPECT_LT(distance(lightGoes(node["rotation"]), -dvec3(rig.lights[i].direction)), 1e-6) << i;
    const size_t index = node["extensions"]["KHR_lights_punctual"]["light"];
    const json& light = gltf["extensions"]["KHR_lights_punctual"]["lights"][index];
    EXPECT_EQ(light["type"], "directional");
    for (int c = 0; c < 3; ++c) {
      const double color = light["color"][c], irradiance = 683 * rig.lights[i].irradiance[c];
      EXPECT_LE(color, 1);
      EXPECT_NEAR(color * light["intensity"].get<double>(), irradiance, 1e-6 * irradiance);
    }
  }
}

// Reading with the units of the writer gives the same lights; with the other units they differ by
// 683.
TEST(LightFile, GltfRoundTrips) {
  const TemporaryFolder folder;
  LightRig rig = exampleRig();
  for (const LightUnits written : {LightUnits::Photometric, LightUnits::Radiometric})
    for (const LightUnits read : {LightUnits::Photometric, LightUnits::Radiometric}) {
      rig.units = written;
      writeLights(folder / "a.gltf", rig);
      GltfChoice choice;
      choice.lightUnits = read;
      const Scene scene = loadGltf(folder / "a.gltf", {}, nullptr, choice);
      const float factor = lumensPerWatt(written) / lumensPerWatt(read);
      size_t i = 0;
      for (const DirectionalLight& light : rig.lights) {
        if (isBlack(light.irradiance)) continue;
        ASSERT_LT(i, scene.lights.size());
        const PunctualLight& back = scene.lights[i++];
        EXPECT_LT(glm::distance(back.direction, -light.direction), 1e-5f);
        EXPECT_NEAR(glm::distance(back.intensity, factor * light.irradiance), 0,
                    1e-5f * factor * maxComponent(light.irradiance));
      }
    }
}

TEST(LightFile, GltfHasNoEmptyLists) {
  const TemporaryFolder folder;
  writeLights(folder / "a.gltf", {"p", "m", {}, {}});
  EXPECT_EQ(fileContents(folder / "a.gltf").find("[]"), std::string::npos);
}

TEST(LightFile, CsvHasALinePerLight) {
  const TemporaryFolder folder;
  LightRig rig = exampleRig();
  rig.lights.resize(2);
  rig.lights[0].direction = vec3(0, 1, 0);
  writeLights(folder / "a.csv", rig);
  EXPECT_EQ(fileContents(folder / "a.csv"),
            "x,y,z,r,g,b,angle\n0,1,0,5,2,1,0\n0,0,-1,0,0.25,0.33333334,0.53\n");
}

// 1 degree: 2.392e-4 (Madsen and Laursen 2007, eq. 5). 90 degrees: pi / 2.
TEST(LightFile, RadianceOfLightsWithAnAngle) {
  EXPECT_NEAR(projectedSolidAngle(1), 2.3924e-4, 5e-9);
  EXPECT_NEAR(projectedSolidAngle(90), kPiD / 2, 1e-12);
  const TemporaryFolder folder;
  LightRig rig = exampleRig();
  rig.lights[0].angle = 1;
  writeLights(folder / "a.json", rig);
  const json lights = jsonOfFile(folder / "a.json")["lights"];
  EXPECT_NEAR(lights[0]["radiance"][0].get<double>() * projectedSolidAngle(1), 5, 1e-5);
  EXPECT_TRUE(lights[1].contains("radiance"));
  EXPECT_FALSE(lights[2].contains("radiance"));
  // A radiance beyond the range of a float.
  rig.lights[0].irradiance.x = 3e37f;
  EXPECT_THROW(writeLights(folder / "b.json", rig), RunError);
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.json"}));
}

// The numbers of an array `name` in C, four to a row.
std::vector<vec4> rowsOf(const std::string& source, const std::string& name) {
  std::vector<vec4> rows;
  const size_t begin = source.find(name + "[");
  if (begin == std::string::npos) return rows;
  std::string body = source.substr(begin, source.find(';', begin) - begin);
  for (size_t at = body.find('=');;) {
    at = body.find_first_of("-0123456789", at);
    if (at == std::string::npos) return rows;
    vec4 row(0);
    int length = 0;
    if (std::sscanf(body.c_str() + at, "%f, %f, %f, %f%n", &row.x, &row.y, &row.z, &row.w,
                    &length) != 4)
      return rows;
    rows.push_back(row);
    at += length;
  }
}

// Equation 4 of Madsen et al. (2003), with kd = ka = 1 and a white surface, evaluated with the
// written numbers, is the radiance of a white Lambertian surface: irradiance / pi.
TEST(LightFile, OpenGlLightsAWhiteSurface) {
  const TemporaryFolder folder;
  LightRig rig = exampleRig();
  rig.lights.pop_back();
  rig.probe = "a */ #error\n.hdr";
  writeLights(folder / "a.h", rig);
  const std::string source = fileContents(folder / "a.h");
  EXPECT_EQ(source.find("*/"), source.rfind("*/")) << "the name ends the comment";
  const auto directions = rowsOf(source, "kProbeDirection"),
             colors = rowsOf(source, "kProbeDiffuse"), ambient = rowsOf(source, "kProbeAmbient");
  ASSERT_EQ(directions.size(), 3u);
  ASSERT_EQ(colors.size(), 3u);
  ASSERT_EQ(ambient.size(), 1u);
  const std::vector<vec3> normals = icosphereNormals(2);
  const std::vector<dvec3> expected = irradianceOf(rig.lights, *rig.ambient, normals);
  for (size_t i = 0; i < normals.size(); ++i) {
    vec3 radiance(ambient[0]);
    for (size_t j = 0; j < 3; ++j) {
      EXPECT_EQ(directions[j].w, 0);
      radiance += vec3(colors[j]) * std::max(0.0f, dot(normals[i], vec3(directions[j])));
    }
    EXPECT_LT(glm::distance(dvec3(radiance), expected[i] / kPiD), 1e-5);
  }
  // Without lights there are no empty arrays, which C lacks.
  writeLights(folder / "b.h", {"p", "m", {}, {}});
  EXPECT_EQ(fileContents(folder / "b.h").find("[][4]"), std::string::npos);
}

TEST(LightFile, FormatsByNameAndByExtension) {
  EXPECT_EQ(lightFormat("a.json", "", ""), LightFormat::Json);
  EXPECT_EQ(lightFormat("a.h", "", ""), LightFormat::OpenGl);
  EXPECT_EQ(lightFormat("a.json", "opengl", "--format"), LightFormat::OpenGl);
  for (const char* name : {"a.opengl", "a", "a.", "json"})
    EXPECT_THROW(lightFormat(name, "", ""), InputError) << name;
  EXPECT_THROW(lightFormat("a.json", "opengles", "--format"), InputError);
}

TEST(LightFile, RejectsLightsThatAreNotFiniteAndUnknownExtensions) {
  const TemporaryFolder folder;
  LightRig rig = exampleRig();
  EXPECT_THROW(writeLights(folder / "a.txt", rig), InputError);
  rig.lights[1].irradiance.y = INFINITY;
  EXPECT_THROW(writeLights(folder / "a.json", rig), RunError);
  EXPECT_TRUE(folder.files().empty());
}

TEST(LightError, MeanAndMaximumAgainstClosedForms) {
  const std::vector<vec3> normals = icosphereNormals(5);
  const Constellation sun{{vec3(0, 1, 0), Rgb(4), 0}};
  const auto lit = irradianceOf(sun, Rgb(0), normals);
  // E = 4 max(0, y): mean 1, at most 4.
  const LightError none = lightError(std::vector<dvec3>(normals.size(), dvec3(0)), lit);
  EXPECT_NEAR(none.mean, 100, 1e-3);
  EXPECT_NEAR(none.max, 400, 0.2);
  const LightError same = lightError(lit, lit);
  EXPECT_EQ(same.mean, 0);
  EXPECT_EQ(same.max, 0);
  // An ambient radiance of 1/pi is irradiance 1 everywhere: the mean of |4 max(0, y) - 1| is 9/8.
  const LightError ambient = lightError(irradianceOf({}, Rgb(kInvPi), normals), lit);
  EXPECT_NEAR(ambient.mean, 112.5, 0.1);
  EXPECT_NEAR(ambient.max, 300, 0.2);
}

TEST(LightError, AveragesTheMeasureOverRgb) {
  const std::vector<dvec3> probe{{1, 2, 3}, {3, 2, 1}}, lights{{1.5, 2, 3}, {3, 2, 2}};
  const LightError error = lightError(lights, probe);
  EXPECT_NEAR(error.mean, 100 * (0.25 + 0 + 0.5) / 3 / 2, 1e-9);
  EXPECT_NEAR(error.max, 100 * (0.5 + 0 + 1.0) / 3 / 2, 1e-9);
}

TEST(LightError, OfABlackProbe) {
  const std::vector<dvec3> black{dvec3(0)}, lit{dvec3(1)};
  EXPECT_EQ(lightError(black, black).max, 0);
  EXPECT_TRUE(std::isinf(lightError(lit, black).mean));
}

}  // namespace
}  // namespace chromeball::light_file_test
