// SPDX-License-Identifier: Apache-2.0
// Sample models that document their correct appearance: the renders must match.
#include <gtest/gtest.h>

#include <map>

#include "probe/synth.h"
#include "sample_model.h"
#include "scene/bounds.h"
#include "test_scene.h"

namespace chromeball::gltf_pixels_test {
namespace {

// A front view by an orthographic camera of exactly the size of the model, under a constant probe.
struct Front {
  Bounds box;
  Image image;

  Front(const Scene& scene, int height, int samples = 16) : box(bounds(scene)) {
    const vec3 size = box.max - box.min;
    Camera camera;
    camera.orthographic = true;
    camera.position = {0.5f * (box.min.x + box.max.x), 0.5f * (box.min.y + box.max.y),
                       box.max.z + 1};
    camera.halfHeight = 0.5f * size.y;
    const int width = int(std::lround(float(height) * size.x / size.y));
    const Probe white(constantProbe({16, 8}, Rgb(1)));
    RenderSettings settings = smallRender(width, height, samples, 1);
    settings.hideProbe = true;
    image = renderScene(scene, camera, white, "uniform", settings).film.mean();
  }

  vec2 pixelOf(const vec3& p) const {
    return {(p.x - box.min.x) / (box.max.x - box.min.x) * float(image.width),
            (box.max.y - p.y) / (box.max.y - box.min.y) * float(image.height)};
  }
  Rgb at(const vec3& p) const {
    const vec2 pixel = pixelOf(p);
    return image.rgb(int(pixel.x), int(pixel.y));
  }
  template <class Is>
  int count(const Is& is) const {
    int n = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) n += is(image.rgb(x, y));
    return n;
  }
};

bool isRed(const Rgb& c) { return c.x > 0.08f && c.x > 2.5f * c.y && c.x > 2.5f * c.z; }
bool isGreen(const Rgb& c) { return c.y > 0.08f && c.y > 2.5f * c.x && c.y > 2.5f * c.z; }

vec3 centreOf(const Scene& scene, const Instance& instance) {
  Bounds box;
  for (const vec3& p : scene.meshes[size_t(instance.mesh)].positions) {
    box.min = glm::min(box.min, instance.point(p));
    box.max = glm::max(box.max, instance.point(p));
  }
  return 0.5f * (box.min + box.max);
}

// A wrong result shows a red cross, a correct one a green check mark.
TEST(SlowGltfPixels, ChecksAndNoCrosses) {
  for (const char* name : {"TextureSettingsTest", "NegativeScaleTest", "AlphaBlendModeTest"}) {
    const auto scene = sampleModel(name);
    if (!scene) GTEST_SKIP() << "no sample models";
    const Front front(*scene, 160);
    EXPECT_EQ(front.count(isRed), 0) << name;
    EXPECT_GT(front.count(isGreen), 100) << name;
  }
}

// Vertex colours remove two channels from each check mark; without them a cross would show.
TEST(GltfPixels, VertexColorTest) {
  const auto scene = sampleModel("VertexColorTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  const Front front(*scene, 160);
  const auto secondary = [](const Rgb& c) {  // cyan, magenta or yellow
    const float minimum = std::min({c.x, c.y, c.z}), maximum = maxComponent(c);
    const float middle = c.x + c.y + c.z - minimum - maximum;
    return middle > 0.1f && minimum < 0.25f * middle;
  };
  EXPECT_LT(front.count(secondary), 5);  // where edges blend
  EXPECT_GT(front.count(isRed), 100);
  EXPECT_GT(front.count(isGreen), 100);
}

// In each row of spheres, factors and three texture encodings define the same material.
TEST(SlowGltfPixels, TextureEncodingTest) {
  const auto scene = sampleModel("TextureEncodingTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  const Front front(*scene, 160, 256);
  std::map<int, std::vector<Rgb>> rows;
  for (const Instance& instance : scene->instances) {
    if (scene->meshes[size_t(instance.mesh)].positions.size() < 100) continue;  // a label
    const vec3 centre = centreOf(*scene, instance);
    rows[int(std::lround(4 * centre.y))].push_back(front.at(centre));
  }
  EXPECT_EQ(rows.size(), 3u);
  for (const auto& [row, colors] : rows) {
    EXPECT_EQ(colors.size(), 4u);
    for (const Rgb& c : colors)
      EXPECT_NEAR(glm::distance(c, colors[0]), 0, 0.02f * maxComponent(colors[0])) << row;
  }
}

// Halfway between a black texel and a green one is half the light.
TEST(GltfPixels, TextureLinearInterpolationTest) {
  const auto scene = sampleModel("TextureLinearInterpolationTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  const Front front(*scene, 80);
  const Rgb factor = front.at({-1.5f, -1, 0}), texture = front.at({1.5f, -1, 0});
  EXPECT_GT(factor.y, 0.4f);
  EXPECT_NEAR(glm::distance(factor, texture), 0, 0.01f);
}

// The upper quads show check marks on green, blue and cyan; yellow would be a missing offset. On
// the lower quads the tip of the arrow is at the marker "Correct".
TEST(GltfPixels, TextureTransformTest) {
  const auto scene = sampleModel("TextureTransformTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  const Front front(*scene, 200);
  int yellow = 0;
  for (int y = 0; y < front.image.height * 2 / 5; ++y)
    for (int x = 0; x < front.image.width; ++x) {
      const Rgb c = front.image.rgb(x, y);
      yellow += c.x > 0.1f && c.y > 0.1f && c.z < 0.3f * std::min(c.x, c.y);
    }
  EXPECT_EQ(yellow, 0);

  const Image& image = front.image;
  const auto isArrow = [&](int x, int y) {  // dark, and not on the edge of the quad
    if (x < 2 || y < 2 || x >= image.width - 2 || y >= image.height - 2) return false;
    for (int dy = -2; dy <= 2; dy += 2)
      for (int dx = -2; dx <= 2; dx += 2)
        if (isBlack(image.rgb(x + dx, y + dy))) return false;
    return maxComponent(image.rgb(x, y)) < 0.12f;
  };
  const auto isNear = [&](const vec3& marker) {  // within the width of a marker
    const vec2 m = front.pixelOf(marker), unit = front.pixelOf(marker + vec3(0.16f, 0, 0)) - m;
    for (int y = int(m.y - unit.x); y <= int(m.y + unit.x); ++y)
      for (int x = int(m.x - unit.x); x <= int(m.x + unit.x); ++x)
        if (isArrow(x, y)) return true;
    return false;
  };
  for (const Instance& instance : scene->instances) {
    const std::string& name = scene->nodeNames[size_t(instance.node)];
    if (name.find(" - ") == std::string::npos) continue;
    EXPECT_EQ(isNear(centreOf(*scene, instance)), name.ends_with("Correct")) << name;
  }
}

// Each arrow, rotated by its node, points at a target of its colour that is not rotated.
TEST(GltfPixels, OrientationTest) {
  const auto scene = sampleModel("OrientationTest");
  if (!scene) GTEST_SKIP() << "no sample models";
  std::map<std::string, const Instance*> byName;
  for (const Instance& i : scene->instances) byName[scene->nodeNames[size_t(i.node)]] = &i;
  for (const char* which : {"X1", "X2", "Y1", "Y2", "Z1", "Z2"}) {
    const Instance& arrow = *byName.at(std::string("Arrow") + which);
    const Instance& target = *byName.at(std::string("Target") + which);
    EXPECT_EQ(arrow.material, target.material);
    vec3 aim = centreOf(*scene, target), tip(0);
    aim[which[0] - 'X'] = 0;
    for (const vec3& position : scene->meshes[size_t(arrow.mesh)].positions) {
      vec3 p = arrow.point(position);
      p[which[0] - 'X'] = 0;
      if (glm::length(p) > glm::length(tip)) tip = p;
    }
    EXPECT_GT(glm::dot(glm::normalize(tip), glm::normalize(aim)), std::cos(0.15f)) << which;
  }
}

}  // namespace
}  // namespace chromeball::gltf_pixels_test
