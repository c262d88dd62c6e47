// SPDX-License-Identifier: Apache-2.0
// Animations at a given time: closed forms of each interpolation, and rejected input.
#include <gtest/gtest.h>

#include "base/error.h"
#include "gltf_writer.h"
#include "scene/gltf/load_gltf.h"

namespace chromeball::gltf_animation_test {
namespace {

using nlohmann::json;

Scene at(GltfWriter& w, double seconds, const std::string& name = "") {
  GltfChoice choice;
  choice.animation = {name, "--animation", seconds};
  return loadGltf(
      w.save(), {}, [&](const std::string& line) { w.warnings.push_back(line); }, choice);
}

std::string errorMessageOf(GltfWriter& w, const std::string& name = "") {
  try {
    at(w, 0, name);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

int scalars(GltfWriter& w, const std::vector<float>& f) {
  return w.accessor(w.view(f), kFloat, "SCALAR", f.size());
}
int vec4s(GltfWriter& w, const std::vector<float>& f) {
  return w.accessor(w.view(f), kFloat, "VEC4", f.size() / 4);
}

void animate(GltfWriter& w, int node, const char* path, const char* interpolation, int times,
             int values) {
  w.add("animations",
        {{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
         {"samplers", {{{"input", times}, {"output", values}, {"interpolation", interpolation}}}}});
}

// The position of the first vertex of a triangle.
vec3 origin(const Scene& scene) { return scene.meshes.at(0).positions.at(0); }

vec3 translated(const char* interpolation, const std::vector<float>& times,
                const std::vector<float>& values, double seconds) {
  GltfWriter w;
  addTriangle(w, {}, {{"translation", {9, 9, 9}}});
  animate(w, 0, "translation", interpolation, scalars(w, times), w.vec3s(values));
  return origin(at(w, seconds));
}

TEST(GltfAnimation, StepAndLinear) {
  const std::vector<float> times{1, 2, 4}, values{0, 0, 1, 2, 0, 1, 2, 8, 1};
  const auto expectAt = [&](const char* how, double seconds, vec3 expected) {
    EXPECT_NEAR(glm::distance(translated(how, times, values, seconds), expected), 0, 1e-6)
        << how << " at " << seconds;
  };
  expectAt("STEP", 1.99, {0, 0, 1});
  expectAt("STEP", 2, {2, 0, 1});
  expectAt("LINEAR", 1.25, {0.5f, 0, 1});
  expectAt("LINEAR", 3.5, {2, 6, 1});
  for (const char* how : {"STEP", "LINEAR"}) {
    expectAt(how, -5, {0, 0, 1});  // before the first key and after the last one
    expectAt(how, 99, {2, 8, 1});
  }
}

// Keys are floats, of which about half are later than the frame's time, which is a double. Some
// programs multiply by the time of a frame in floats.
TEST(GltfAnimation, AKeyIsReachedAtTheTimeOfItsFrame) {
  constexpr int kFrames = 100;
  for (const double fps : {24.0, 25.0, 30.0, 23.976, 1e9}) {
    std::vector<float> divided, multiplied, values;
    for (int n = 0; n < kFrames; ++n) {
      divided.push_back(float(n / fps));
      multiplied.push_back(float(n) * float(1 / fps));
      values.insert(values.end(), {float(n), 0, 0});
    }
    for (const std::vector<float>& times : {divided, multiplied}) {
      GltfWriter w;
      addTriangle(w);
      animate(w, 0, "translation", "STEP", scalars(w, times), w.vec3s(values));
      for (int n = 1; n < kFrames; n += 9)
        EXPECT_EQ(origin(at(w, n / fps)).x, n) << fps << " frames per second";
      EXPECT_EQ(origin(at(w, 10.99 / fps)).x, 10);
    }
  }
}

// Two linear keys at one time are a jump; a time just below it has the state after it.
TEST(GltfAnimation, AJumpOfLinearKeysIsReachedToo) {
  const std::vector<float> values{0, 0, 0, 1, 0, 0, 5, 0, 0, 6, 0, 0};
  EXPECT_EQ(translated("LINEAR", {0, 0.1f, 0.1f, 1}, values, 0.1).x, 5);
  EXPECT_NEAR(translated("LINEAR", {0, 0.1f, 0.1f, 1}, values, 0.0999).x, 0.999, 1e-5);
}

// A Hermite spline with the values and tangents of a cubic is that cubic.
TEST(GltfAnimation, CubicSplineOfACubicIsExact) {
  const auto cubic = [](double t) { return ((t - 3) * t + 0.5) * t + 2; };
  const auto slope = [](double t) { return (3 * t - 6) * t + 0.5; };
  std::vector<float> times{0.5f, 1, 3}, values;
  for (float t : times)
    for (double x : {slope(t), cubic(t), slope(t)})
      values.insert(values.end(), {float(x), 0, float(-2 * x)});
  for (double t : {0.5, 0.7, 1.0, 1.6, 2.9, 3.0}) {
    const vec3 p = translated("CUBICSPLINE", times, values, t);
    EXPECT_NEAR(p.x, cubic(t), 1e-5) << t;
    EXPECT_NEAR(p.z, -2 * cubic(t), 2e-5) << t;
  }
}

TEST(GltfAnimation, RotationTakesTheShorterArcAtConstantSpeed) {
  const float s = std::sqrt(0.5f);
  for (float sign : {1.0f, -1.0f}) {  // q and -q are the same rotation
    GltfWriter w;
    addTriangle(w);
    animate(w, 0, "rotation", "LINEAR", scalars(w, {0, 3}),
            vec4s(w, {0, 0, 0, 1, 0, 0, sign * s, sign * s}));  // 90 degrees about Z
    for (double t : {0.0, 1.0, 2.0, 3.0}) {
      const double angle = t / 3 * kPiD / 2;
      const vec3 x = at(w, t).meshes[0].positions[1];
      EXPECT_NEAR(glm::distance(x, vec3(std::cos(angle), std::sin(angle), 0)), 0, 1e-6);
    }
  }
}

TEST(GltfAnimation, NormalisedIntegersAndScale) {
  GltfWriter w;
  addTriangle(w);
  const std::vector<int16_t> half{0, 0, 23170, 23170};  // 90 degrees about Z
  animate(w, 0, "rotation", "STEP", scalars(w, {0}),
          w.accessor(w.view(half), kShort, "VEC4", 1, 0, true));
  w.root["animations"][0]["samplers"].push_back(
      {{"input", scalars(w, {0, 1})}, {"output", w.vec3s({1, 1, 1, 3, 1, 1})}});
  w.root["animations"][0]["channels"].push_back(
      {{"sampler", 1}, {"target", {{"node", 0}, {"path", "scale"}}}});
  EXPECT_NEAR(glm::distance(at(w, 0.5).meshes[0].positions[1], vec3(0, 2, 0)), 0, 1e-6);
}

TEST(GltfAnimation, MorphWeights) {
  GltfWriter w;
  const int first = w.vec3s({1, 0, 0, 1, 0, 0, 1, 0, 0});
  const int second = w.vec3s({0, 1, 0, 0, 1, 0, 0, 1, 0});
  addTriangle(w, {{"targets", {{{"POSITION", first}}, {{"POSITION", second}}}}});
  animate(w, 0, "weights", "LINEAR", scalars(w, {0, 1}), scalars(w, {0, 4, 2, 0}));
  EXPECT_NEAR(glm::distance(origin(at(w, 0.25)), vec3(0.5f, 3, 0)), 0, 1e-6);
  // Each key of a cubic spline has all in-tangents, then all values, then all out-tangents.
  w.root.erase("animations");
  animate(w, 0, "weights", "CUBICSPLINE", scalars(w, {0, 2}),
          scalars(w, {7, 7, 0, 0, 1, 2, 1, 2, 2, 4, 7, 7}));  // slopes of 1 and 2 per second
  EXPECT_NEAR(glm::distance(origin(at(w, 0.5)), vec3(0.5f, 1, 0)), 0, 1e-6);
}

TEST(GltfAnimation, EachKeyHasAWeightForEachMorphTarget) {
  const std::vector<std::vector<float>> outputs = {{0, 4, 2, 0, 1, 1}, {0, 4}};
  for (const std::vector<float>& weights : outputs) {
    GltfWriter w;
    const int moved = w.vec3s({1, 0, 0, 1, 0, 0, 1, 0, 0});
    addTriangle(w, {{"targets", {{{"POSITION", moved}}, {{"POSITION", moved}}}}});
    animate(w, 0, "weights", "LINEAR", scalars(w, {0, 1}), scalars(w, weights));
    EXPECT_NE(errorMessageOf(w).find("meshes[0] has 2 morph targets"), std::string::npos);
  }
}

// Only those: the others keep their values, which is said where the target has a weight.
TEST(GltfAnimation, MorphTargetsMovePositionsNormalsAndTangents) {
  for (const char* name : {"COLOR_0", "TEXCOORD_0"})
    for (const float weight : {0.0f, 1.0f}) {
      GltfWriter w;
      const int moved = w.vec3s({1, 0, 0, 1, 0, 0, 1, 0, 0});
      json target;
      target["POSITION"] = target[name] = moved;
      json primitive;
      primitive["targets"].push_back(target);
      const int node = addTriangle(w, primitive);
      w.root["nodes"][size_t(node)]["weights"].push_back(weight);
      EXPECT_EQ(origin(w.load()).x, weight);
      ASSERT_EQ(w.warnings.size(), weight > 0 ? 1u : 0u) << name;
      const std::string said = weight > 0 ? w.warnings[0] : "";
      EXPECT_EQ(said.find(std::string("ignored: ") + name + " of morph targets") != said.npos,
                weight > 0)
          << said;
    }
}

// A skin follows its joints, and so do its normals.
TEST(GltfAnimation, SkinsFollowTheirJoints) {
  GltfWriter w;
  const int joints = w.accessor(w.view(std::vector<uint8_t>(12, 0)), kUByte, "VEC4", 3);
  const int weights = vec4s(w, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const int normals = w.vec3s({0, 0, 1, 0, 0, 1, 0, 0, 1});
  addTriangle(w,
              {{"attributes", {{"JOINTS_0", joints}, {"WEIGHTS_0", weights}, {"NORMAL", normals}}}},
              {{"skin", 0}});
  const int joint = w.add("nodes", {{"name", "joint"}});
  w.add("skins", {{"joints", {joint}}});
  const float s = std::sqrt(0.5f);
  animate(w, joint, "rotation", "LINEAR", scalars(w, {0, 1}),
          vec4s(w, {0, 0, 0, 1, 0, s, 0, s}));  // 90 degrees about Y
  const Scene scene = at(w, 1);
  EXPECT_NEAR(glm::distance(scene.meshes[0].positions[1], vec3(0, 0, -1)), 0, 1e-6);
  EXPECT_NEAR(glm::distance(scene.meshes[0].normals[1], vec3(1, 0, 0)), 0, 1e-6);
}

TEST(GltfAnimation, IsSelectedByNameOrIndex) {
  GltfWriter w;
  addTriangle(w);
  animate(w, 0, "translation", "STEP", scalars(w, {0}), w.vec3s({1, 0, 0}));
  animate(w, 0, "translation", "STEP", scalars(w, {0}), w.vec3s({2, 0, 0}));
  w.root["animations"][1]["name"] = "Walk";
  EXPECT_EQ(origin(at(w, 0)).x, 1);
  EXPECT_EQ(origin(at(w, 0, "0")).x, 1);
  EXPECT_EQ(origin(at(w, 0, "Walk")).x, 2);
  EXPECT_NE(
      errorMessageOf(w, "Wolk").find("no animation `Wolk` (--animation); did you mean `Walk`?"),
      std::string::npos);
  const Scene rest = w.load();
  EXPECT_EQ(origin(rest).x, 0);
  EXPECT_TRUE(w.warnings.empty());
  ASSERT_EQ(rest.notes.size(), 1u);
  EXPECT_NE(rest.notes[0].find("rest pose"), std::string::npos);
  EXPECT_TRUE(rest.notes[0].ends_with("`0`, `Walk`")) << rest.notes[0];
}

// Channels of KHR_animation_pointer have no node, which the specification allows.
TEST(GltfAnimation, ChannelsWithoutANodeAreIgnored) {
  for (const json& target :
       {json{{"path", "translation"}},
        json{{"path", "pointer"},
             {"extensions",
              {{"KHR_animation_pointer", {{"pointer", "/materials/0/emissiveFactor"}}}}}}}) {
    GltfWriter w;
    addTriangle(w);
    animate(w, 0, "translation", "STEP", scalars(w, {0}), w.vec3s({1, 0, 0}));
    w.root["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", target}});
    EXPECT_EQ(origin(w.load()).x, 0);
    EXPECT_EQ(origin(at(w, 0)).x, 1) << "the other channels must be applied";
    ASSERT_FALSE(w.warnings.empty());
    EXPECT_NE(w.warnings.back().find("animation"), std::string::npos) << w.warnings.back();
  }
}

// A crowd whose members share their keys is as small as its file.
TEST(GltfAnimation, ChannelsMayShareASampler) {
  constexpr int kNodes = 1200, kKeys = 20000;
  GltfWriter w;
  std::vector<float> times, values;
  for (int i = 0; i < kKeys; ++i) {
    times.push_back(float(i));
    values.insert(values.end(), {float(i), 0, 0});
  }
  json channels = json::array();
  addTriangle(w, {}, {{"translation", {9, 9, 9}}});
  for (int i = 0; i < kNodes; ++i) {
    if (i > 0) w.add("nodes", {{"mesh", 0}});
    channels.push_back({{"sampler", 0}, {"target", {{"node", i}, {"path", "translation"}}}});
  }
  w.add("animations",
        {{"channels", channels},
         {"samplers", {{{"input", scalars(w, times)}, {"output", w.vec3s(values)}}}}});
  const Scene scene = at(w, 3.5);
  ASSERT_EQ(scene.instances.size(), size_t(kNodes));
  for (const Instance& instance : scene.instances)
    EXPECT_NEAR(instance.point(scene.meshes[size_t(instance.mesh)].positions[0]).x, 3.5f, 1e-5f);
}

TEST(GltfAnimation, InvalidAnimationsAreRejected) {
  const auto errorMessage = [](const json& channel, const json& sampler, const json& node = {}) {
    GltfWriter w;
    addTriangle(w, {}, node);
    scalars(w, {0, 1});
    w.vec3s({0, 0, 0, 1, 1, 1});
    scalars(w, {1, 0});
    w.vec3s({0, 0, NAN, 1, 1, 1});
    json c = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}};
    json s = {{"input", 1}, {"output", 2}};
    c.merge_patch(channel), s.merge_patch(sampler);
    w.add("animations", {{"channels", {c}}, {"samplers", {s}}});
    return errorMessageOf(w);
  };
  const auto holds = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_EQ(errorMessage(json::object(), json::object()), "");
  EXPECT_TRUE(holds(errorMessage({{"sampler", 3}}, json::object()), "samplers[3] does not exist"));
  EXPECT_TRUE(holds(errorMessage({{"target", {{"node", 7}}}}, json::object()), "nodes[7]"));
  EXPECT_TRUE(
      holds(errorMessage(json::object(), {{"input", 3}}), "not in ascending order of time"));
  EXPECT_TRUE(holds(errorMessage(json::object(), {{"output", 4}}), "not finite"));
  EXPECT_TRUE(holds(errorMessage(json::object(), {{"output", 1}}), "1 components; it must have 3"));
  EXPECT_TRUE(
      holds(errorMessage(json::object(), {{"interpolation", "CUBICSPLINE"}}), "do not match"));
  EXPECT_TRUE(holds(errorMessage(json::object(), {{"interpolation", "Linear"}}), "is not STEP"));
  EXPECT_TRUE(holds(errorMessage(json::object(), json::object(),
                                 {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}),
                    "has a matrix"));
  GltfWriter still;
  addTriangle(still);
  EXPECT_TRUE(holds(errorMessageOf(still), "has no animation"));
}

}  // namespace
}  // namespace chromeball::gltf_animation_test
