// SPDX-License-Identifier: Apache-2.0
// tests/ENVELOPE.md: the rows about geometry.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cstdlib>
#include <fstream>
#include <functional>

#include "envelope.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "probe/synth.h"
#include "run_command.h"
#include "scene/builder/scene_builder.h"
#include "session/render_loaded.h"

namespace chromeball::envelope_geometry_test {
namespace {

// A ball on a table; the radius of the ball is `scale` metres.
Scene ballOnTable(float scale) {
  Scene scene;
  const int grey = addMaterial(scene, lambert(Rgb(0.6f)));
  Material coated = lambert(Rgb(0.8f, 0.3f, 0.2f));
  coated.specular = 1;
  coated.roughness = 0.3f;
  addQuad(scene, grey, scale * vec3(-2, -1, 2), scale * vec3(4, 0, 0), scale * vec3(0, 0, -4));
  addSphere(scene, addMaterial(scene, coated), vec3(0), scale, 24);
  return scene;
}

TEST(SlowEnvelopeGeometry, SceneScaleFrom1e_4To1e7) {
  const Probe probe(gradientProbe({64, 32}, Rgb(1), {0.2, 0.7, 0.3}));
  Image reference;
  for (float scale : {1.0f, 1e-4f, 1e-2f, 1e3f, 1e7f}) {
    const Camera camera = Camera::lookAt(scale * vec3(1, 1.5f, 5), vec3(0), {0, 1, 0}, 0.7f);
    const RenderResult r =
        renderScene(ballOnTable(scale), camera, probe, "importance", smallRender(32, 32, 64, 4));
    validMean(r);
    const Image mean = r.film.mean();
    if (scale == 1.0f) {
      reference = mean;
      continue;
    }
    double squares = 0;  // rounding makes a few paths diverge; their number must stay small
    for (size_t i = 0; i < mean.texels.size(); ++i)
      squares += std::pow(mean.texels[i] - reference.texels[i], 2);
    EXPECT_LT(std::sqrt(squares / double(mean.texels.size())), 4e-3) << scale;
    EXPECT_NEAR(validMean(r) / luminance(meanColor(reference)), 1, 1e-3) << scale;
  }
}

// The squared length of the cross product of a triangle's edges is beyond the range of a float from
// 4e9 m on, and below it up to 3e-10 m.
TEST(EnvelopeGeometry, NormalsOfTrianglesOfAnySize) {
  for (const float size : {1e-13f, 1e-11f, 1e-5f, 1.0f, 1e5f, 1e9f, 1e11f, 1e13f}) {
    Scene scene;
    addQuad(scene, addMaterial(scene, lambert(Rgb(0.6f))), {-size, 0, size}, {2 * size, 0, 0},
            {0, size, -2 * size});
    const Surface surface =
        surfaceAt(scene, scene.instances[0], 0, vec2(0.3f), vec3(0.6f, 0.8f, 0));
    const vec3 expected(0, 2 / std::sqrt(5.0f), 1 / std::sqrt(5.0f));
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(surface.geometricNormal[k], expected[k], 1e-6f) << size;
      EXPECT_NEAR(surface.normal[k], expected[k], 1e-6f) << size;
    }
  }
}

// Vertex normals under a transform by such a factor keep their direction.
TEST(EnvelopeGeometry, VertexNormalsUnderTransformsOfAnyScale) {
  for (const float scale : {1e-10f, 1.0f, 1e10f}) {
    Scene scene;
    const int material = addMaterial(scene, lambert(Rgb(0.6f)));
    addSphere(scene, material, vec3(0), 1 / scale, 8);
    Instance& instance = scene.instances[0];
    instance.toWorld = Transform{};
    instance.toWorld->linear = glm::mat3(scale);
    const Surface surface = surfaceAt(scene, instance, 60, vec2(0.3f), vec3(0, 1, 0));
    const vec3 expected = glm::normalize(surface.position);
    EXPECT_GT(glm::distance(surface.geometricNormal, surface.normal), 0.01f) << scale;
    EXPECT_LT(glm::distance(absolute(surface.normal), absolute(expected)), 0.02f) << scale;
  }
}

// The ground of a composite reaches far beyond the model; so does a disc of light.
TEST(SlowEnvelopeGeometry, GroundAndDiscsOfAnySize) {
  const TemporaryFolder folder;
  const std::string image = folder / "a.exr", scene = folder / "a.toml", probe = folder / "p.exr";
  writeImage(probe, gradientProbe({64, 32}, Rgb(1), {0.2, 0.7, 0.3}));
  const auto meanOf = [&](const std::string& text, const std::vector<std::string>& options,
                          const std::string& layer) {
    std::ofstream(scene) << text;
    std::vector<std::string> words{"render",    scene, "--size", "32x24",
                                   "--samples", "64",  "-o",     image};
    words.insert(words.end(), options.begin(), options.end());
    const CommandResult result = runCommand(words);
    EXPECT_EQ(result.status, 0) << result.error;
    return luminance(
        meanColor(layer.empty() ? readImage(image) : *findLayer(readImageFile(image), layer)));
  };
  const std::string model = std::string(kSourceDir) + "/scenes/models/pillars.gltf";
  const auto ground = [&](double scale) {
    return meanOf(fmt::format("[[model]]\nfile = '{}'\nscale = {:.1f}\n[probe]\nfile = '{}'\n",
                              model, scale, probe),
                  {"--shadow-catcher", "ground", "--aov", "l_noobj"}, "l_noobj");
  };
  const double expected = ground(1);
  EXPECT_GT(expected, 0.05);
  EXPECT_NEAR(ground(1e7) / expected, 1, 1e-3);
  const auto disc = [&](double radius) {
    return meanOf(fmt::format("model = '{}'\n[[light]]\ntype = 'disc'\nposition = [0, {:.1f}, 0]\n"
                              "direction = [0, -1, 0]\nradius = {:.1f}\nradiance = 1\n",
                              model, radius / 10, radius),
                  {}, "");
  };
  const double lit = disc(1e6);
  EXPECT_GT(lit, 0.05);
  EXPECT_NEAR(disc(1e12) / lit, 1, 1e-3);
}

// A model of 1 m at a distance of 1e6 m from the origin renders the same image as at the origin,
// because the scene's centre is subtracted. A scene beyond 1e9 m is rejected.
TEST(EnvelopeGeometry, ASmallObjectFarFromTheOrigin) {
  const TemporaryFolder out;
  const std::string probe = out / "probe.exr";
  writeImage(probe, gradientProbe({32, 16}, Rgb(1), {0.2, 0.7, 0.3}));
  const auto renderAt = [&](const nlohmann::json& translation, const std::string& name) {
    GltfWriter w;
    const Scene ball = ballOnTable(0.5f);
    std::vector<float> positions;
    std::vector<uint16_t> indices;
    for (const vec3& p : ball.meshes[1].positions)
      positions.insert(positions.end(), {p.x, p.y, p.z});
    for (const Triangle& t : ball.meshes[1].triangles)
      for (int k = 0; k < 3; ++k) indices.push_back(uint16_t(t[k]));
    w.add("nodes", {{"mesh", w.mesh({{"attributes", {{"POSITION", w.vec3s(positions)}}},
                                     {"indices", w.indices(indices)}})},
                    {"translation", translation}});
    return runCommand({"render", w.save(), "--probe", probe, "--size", "24x24", "--samples", "16",
                       "--quiet", "-o", out / name});
  };
  ASSERT_EQ(renderAt({0, 0, 0}, "near.pfm").status, 0);
  ASSERT_EQ(renderAt({1e6 + 0.3, -2e6, 3e6 + 0.7}, "far.pfm").status, 0);
  const Image near = readImage(out / "near.pfm"), far = readImage(out / "far.pfm");
  double squares = 0;
  for (size_t i = 0; i < near.texels.size(); ++i)
    squares += std::pow(near.texels[i] - far.texels[i], 2);
  EXPECT_LT(std::sqrt(squares / double(near.texels.size())), 5e-3);

  const CommandResult beyond = renderAt({1e10, 0, 0}, "beyond.pfm");
  EXPECT_EQ(beyond.status, 2);
  EXPECT_NE(beyond.error.find("scale it down"), std::string::npos) << beyond.error;
}

// A model of arrays by transforms, vertices, a camera and a lamp; the offset of the ball is no
// float, the others are.
TEST(EnvelopeGeometry, ArraysFarFromTheOrigin) {
  const auto renderAt = [](const glm::dvec3& at) {
    Scene local;
    addSphere(local, addMaterial(local, lambert(Rgb(0.5f))), {0, 0, 0}, 0.5f, 16);
    auto scene = std::make_shared<Scene>();
    SceneBuilder builder(*scene);
    const int grey = builder.addMaterial(lambert(Rgb(0.5f)));
    const int ball = builder.addMesh(local.meshes.shared(0));
    glm::dmat4 place(1);
    place[3] = glm::dvec4(at + glm::dvec3(0.01, 0.5, 0), 1);
    builder.addInstance(ball, grey, builder.addNode("ball"), place);
    addQuad(*scene, grey, vec3(at) + vec3(-2, 0, 2), {4, 0, 0}, {0, 0, -4});
    builder.addLight({.intensity = Rgb(1), .position = vec3(at) + vec3(2, 3, 1)});
    Camera camera = Camera::lookAt({0, 1, 4}, {0, 0.5f, 0}, {0, 1, 0}, 0.6f);
    camera.position += vec3(at);
    builder.addCamera(camera);
    RenderDescription d;
    d.scene = scene;
    d.probe.map = std::make_shared<const Image>(gradientProbe({32, 16}, Rgb(1), {0.2, 0.7, 0.3}));
    d.lighting.strategy = "importance";
    d.size = ImageSize{24, 24};
    d.settings.samples = 16;
    return renderLoaded(loadScene(d)).color();
  };
  const Image near = renderAt({0, 0, 0}), far = renderAt({1e6, -2e6, 3e6});
  double sum = 0;
  for (size_t i = 0; i < near.texels.size(); ++i) sum += std::fabs(near.texels[i] - far.texels[i]);
  EXPECT_LT(sum / double(near.texels.size()), 1e-3);
}

// A mesh whose coordinates are far from its own origin, which an instance turns and places at that
// of the world: rays are transformed to the mesh and meet rounding errors of its coordinates.
TEST(EnvelopeGeometry, InstancesFarFromTheirOwnOrigin) {
  constexpr float kAlbedo = 0.8f;
  for (const float away : {0.0f, 200.0f, 2000.0f}) {
    Scene scene;
    addSphere(scene, addMaterial(scene, lambert(Rgb(kAlbedo))), {away, 0, 0}, 1, 24, false);
    const glm::mat3 turn(glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(0.2, 1, 0.1)));
    scene.instances[0].toWorld = Transform{turn, turn * vec3(-away, 0, 0)};
    const Camera camera = Camera::lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 0.3f);
    const RenderResult r = renderScene(scene, camera, Probe(constantProbe({8, 4}, Rgb(1))),
                                       "importance", smallRender(16, 16, 64, 4));
    const Image mean = r.film.mean();
    EXPECT_NEAR(meanColor(mean).y, kAlbedo, 1e-3f) << away;
    for (size_t i = 0; i < mean.pixels(); ++i) EXPECT_NEAR(mean.rgb(i).y, kAlbedo, 0.03f) << away;
  }
}

TEST(EnvelopeGeometry, DegenerateTriangles) {
  Scene scene;
  const int grey = addMaterial(scene, lambert(Rgb(0.5f)));
  addQuad(scene, grey, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
  addQuad(scene, grey, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4});     // a duplicate
  addQuad(scene, grey, {-1, 0, 1}, {4, 0, 0.5f}, {0, 0, -4});  // coplanar and overlapping
  Mesh degenerate;
  degenerate.positions = {{0, 0.5f, 0},        {0, 0.5f, 0},  {0, 0.5f, 0},     {1, 0.5f, 0},
                          {0.5f, 0.5f, 1e-7f}, {-1, 0.2f, 0}, {1, 0.2f, 1e-6f}, {1, 0.2f, -1e-6f}};
  degenerate.triangles = {
      {0, 1, 2}, {0, 0, 0}, {0, 3, 3}, {0, 3, 4}, {5, 6, 7}};  // points, lines, slivers
  degenerate.normals.assign(degenerate.positions.size(), vec3(0));
  addMesh(scene, grey, degenerate);
  const Probe probe(constantProbe({8, 4}, Rgb(1)));
  const RenderResult r =
      renderScene(scene, topCamera(3, 40), probe, "importance", smallRender(64, 64, 16, 6));
  // Exitant radiance = albedo x probe radiance = 1/2; the slivers occlude a negligible area.
  EXPECT_NEAR(validMean(r), 0.5, 2e-3);
}

TEST(EnvelopeGeometry, InvalidNormals) {
  const Probe probe(constantProbe({8, 4}, Rgb(1)));
  Material coated = lambert(Rgb(1));
  coated.specular = 1;
  coated.roughness = 0.4f;
  const std::pair<const char*, std::function<vec3(int, vec3)>> corruptions[] = {
      {"long", [](int, vec3 n) { return 1e6f * n; }},
      {"short", [](int, vec3 n) { return 1e-6f * n; }},
      {"zero", [](int, vec3) { return vec3(0); }},
      {"flipped", [](int, vec3 n) { return -n; }},
      {"some zero, some flipped", [](int i, vec3 n) { return float(i % 3 - 1) * n; }},
      {"overflowing", [](int, vec3 n) { return 1e30f * n; }}};
  for (const auto& [name, corrupt] : corruptions) {
    Scene scene;
    addSphere(scene, addMaterial(scene, coated), vec3(0), 1, 16);
    std::vector<vec3>& normals = scene.meshes.edit(0).normals;
    for (size_t i = 0; i < normals.size(); ++i) normals[i] = corrupt(int(i), normals[i]);
    const RenderResult r =
        renderScene(scene, topCamera(5, 20), probe, "importance", smallRender(24, 24, 32, 6));
    const double mean = validMean(r);
    EXPECT_LT(mean, 1.01) << name;  // a white furnace: no energy is created
    EXPECT_GT(mean, 0.9) << name;
  }
}

// Two watertight scenes in which every pixel must be 0: a lamp in a closed box with the camera
// outside, and a closed ball with the camera inside under a bright probe. CHROMEBALL_LEAK_RAYS sets
// the approximate number of rays for each scale.
TEST(SlowEnvelopeGeometry, NoLightLeaksAtAnyScale) {
  const char* variable = std::getenv("CHROMEBALL_LEAK_RAYS");
  const double raysPerScale = variable ? std::atof(variable) : 4e5;
  const Probe black(constantProbe({4, 2}, Rgb(0))), bright(constantProbe({16, 8}, Rgb(1e6f)));
  const glm::mat3 turn(glm::mat3_cast(glm::angleAxis(0.7f, glm::normalize(vec3(1, 2, 3)))));
  double rays = 0;
  for (float scale : {1e-4f, 1e-2f, 1.0f, 1e3f, 1e5f, 1e7f}) {
    Scene lamp;
    Material glow = lambert(Rgb(0.5f));
    glow.emission = Rgb(1e10f);
    const int light = addMaterial(lamp, glow), wall = addMaterial(lamp, lambert(Rgb(0.8f)));
    addSphere(lamp, light, vec3(0), 0.3f * scale, 6);
    // The walls share their vertices: separately rounded ones would leave a crack.
    Mesh box;
    for (int i = 0; i < 8; ++i)
      box.positions.push_back(scale *
                              (turn * vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    for (uint32_t axis : {1u, 2u, 4u})
      for (uint32_t side : {0u, axis}) {
        const uint32_t a = axis == 1 ? 2 : 1, b = axis == 4 ? 2 : 4;
        box.triangles.push_back({side, side + a, side + a + b});
        box.triangles.push_back({side, side + a + b, side + b});
      }
    addMesh(lamp, wall, box);
    Scene ball;
    addSphere(ball, addMaterial(ball, lambert(Rgb(0.8f))), vec3(0.3f, 0.2f, 0.1f) * scale, -scale,
              24, false);

    const int samples = std::max(1, int(raysPerScale / 2 / (64.0 * 64 * 12)));
    const Camera outside = Camera::lookAt(scale * vec3(2, 3, 4), vec3(0), {0, 1, 0}, 0.6f);
    const RenderResult a =
        renderScene(lamp, outside, black, "importance", smallRender(64, 64, 4 * samples, 3));
    const Camera inside =
        Camera::lookAt(scale * vec3(0.1f, 0, 0.2f), scale * vec3(1, 0.3f, -0.5f), {0, 1, 0}, 2.5f);
    const RenderResult b =
        renderScene(ball, inside, bright, "importance", smallRender(64, 64, samples, 8));
    for (const RenderResult* r : {&a, &b}) {
      const Image mean = r->film.mean();
      EXPECT_EQ(*std::max_element(mean.texels.begin(), mean.texels.end()), 0)
          << "a leak at scale " << scale;
      EXPECT_EQ(r->invalid.total(), 0u);
      rays += double(r->rays.camera + r->rays.shadow + r->rays.bounce);
    }
  }
  RecordProperty("rays", std::to_string(rays));
  std::printf("%.3g rays\n", rays);
}

// A lamp in a box with double walls 1e-5 apart, at coordinates of about 1.
TEST(EnvelopeGeometry, ThinWallsDoNotLeakLight) {
  Scene scene;
  Material glow = lambert(Rgb(0.5f));
  glow.emission = Rgb(1e10f);
  const int light = addMaterial(scene, glow), wall = addMaterial(scene, lambert(Rgb(0.8f)));
  addSphere(scene, light, vec3(0), 0.3f, 6);
  for (float half : {0.5f, 0.5f + 1e-5f})
    for (int axis = 0; axis < 3; ++axis)
      for (float side : {-half, half}) {
        vec3 corner(-half), a(0), b(0);
        corner[axis] = side, a[(axis + 1) % 3] = 2 * half, b[(axis + 2) % 3] = 2 * half;
        addQuad(scene, wall, corner, a, b);
      }
  const Camera camera = Camera::lookAt({1, 1.5f, 2}, vec3(0), {0, 1, 0}, 0.8f);
  const Probe black(constantProbe({4, 2}, Rgb(0)));
  const RenderResult r =
      renderScene(scene, camera, black, "importance", smallRender(64, 64, 16, 4));
  EXPECT_EQ(validMean(r), 0);
}

}  // namespace
}  // namespace chromeball::envelope_geometry_test
