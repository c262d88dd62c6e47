// SPDX-License-Identifier: Apache-2.0
// Settings of the automatic camera, the ground, --drop and --turntable, from text to the scene.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "composite/local_scene.h"
#include "front/plan_render.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "run_command.h"
#include "scene/framing.h"
#include "session/load_scene.h"
#include "session/render_loaded.h"
#include "shared_data.h"

namespace chromeball::stand_test {
namespace {

using Given = std::vector<std::pair<std::string, std::string>>;

const std::string kProbe = std::string(kSourceDir) + "/probes/dusk.exr";

// Two triangles in the plane z = 0: one above the other, of which the lower one, `falls`, sinks by
// 4 metres within the second that the animation takes. Its own camera looks along -z.
class Model {
 public:
  GltfWriter w;

  explicit Model(bool hasCamera = false) {
    addTriangle(w, {}, {{"name", "stays"}, {"translation", {0, 4, 0}}});
    addTriangle(w, {}, {{"name", "falls"}, {"translation", {0, 3, 0}}});
    if (hasCamera) {
      w.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}}}});
      w.add("nodes", {{"camera", 0}, {"name", "front"}, {"translation", {0, 3, 9}}});
    }
    w.add("animations",
          {{"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}},
           {"samplers",
            {{{"input", w.accessor(w.view(std::vector<float>{0, 1}), kFloat, "SCALAR", 2)},
              {"output", w.vec3s({0, 3, 0, 0, -1, 0})}}}}});
    w.save();
  }

  RenderDescription plan(const Given& given, const std::string& more = "") const {
    std::ofstream(path()) << "model = \"model.gltf\"\n" << more;
    Settings settings;
    for (const auto& [name, text] : given) settings.parse(name, text);
    settings.parse("probe.file", kProbe);
    return planRender(openScene(path()), settings);
  }
  LoadedScene load(const Given& given, const std::string& more = "") const {
    return loadScene(plan(given, more));
  }
  std::string path() const { return (w.folder() / "scene.toml").string(); }
};

double lowest(const Scene& scene) { return bounds(scene, std::vector<int>{0, 1}).min.y; }

TEST(Stand, TheGroundIsAtTheLowestPointOfAllTimesOrAtAHeight) {
  const Model model;
  const auto heightOf = [&](const Given& given) {
    const Scene scene = model.load(given).scene;
    const Bounds plane = bounds(scene, scene.instances.back());
    EXPECT_EQ(scene.nodeNames[size_t(scene.instances.back().node)], kGroundNode);
    EXPECT_GT(plane.size().x, 100);
    EXPECT_GT(plane.size().z, 100);
    return plane.max.y;
  };
  EXPECT_NEAR(heightOf({{"render.ground", "auto"}}), 3, 1e-3);
  EXPECT_NEAR(heightOf({{"render.ground", "auto"}, {"model.time", "0.5"}}), -1, 1e-3);
  EXPECT_NEAR(heightOf({{"render.ground", "2.5"}}), 2.5, 1e-3);
  EXPECT_NEAR(heightOf({{"render.ground", "auto"}, {"render.drop", "true"}}), 0, 1e-3);
  EXPECT_EQ(model.load({}).scene.instances.size(), 2u);
}

TEST(Stand, TheGroundChangesNoView) {
  const Model model;
  for (const char* turn : {"", "orbit", "turntable"}) {
    Given given;
    if (*turn) given.push_back({turn, "20"});
    const vec3 without = model.load(given).camera.position;
    given.push_back({"render.ground", "auto"});
    EXPECT_EQ(model.load(given).camera.position, without) << turn;
  }
}

TEST(Stand, DropsModelsAndTheViewToTheGround) {
  const Model model;
  const LoadedScene usual = model.load({}), dropped = model.load({{"render.drop", "true"}});
  EXPECT_NEAR(lowest(dropped.scene), 0, 1e-5);
  EXPECT_NEAR(usual.camera.position.y - dropped.camera.position.y, 3, 1e-5);
  EXPECT_NEAR(lowest(model.load({{"render.drop", "true"}, {"render.ground", "-2"}}).scene), -2,
              1e-5);
  // The lowest point of the animation, not of the time that is shown.
  EXPECT_NEAR(lowest(model.load({{"render.drop", "true"}, {"model.time", "0"}}).scene), 4, 1e-5);
}

TEST(Stand, AShadowCatchersGroundIsUnderTheModel) {
  const Model model;
  const auto heightOf = [&](Given given) {
    given.push_back({"shadow-catcher", "ground"});
    return model.load(given).description.composite->groundHeight;
  };
  EXPECT_NEAR(heightOf({}), 3, 1e-5);
  EXPECT_NEAR(heightOf({{"render.ground", "1"}}), 1, 1e-5);
  EXPECT_NEAR(heightOf({{"render.drop", "true"}}), 0, 1e-5);
}

// A vertex turns about the vertical through the models' centre; the camera, also that of the model,
// stands still.
TEST(Stand, ATurntableTurnsTheModelsAlone) {
  for (const bool hasCamera : {false, true}) {
    const Model model(hasCamera);
    const LoadedScene still = model.load({{"turntable", "0"}}),
                      turned = model.load({{"turntable", "90"}});
    EXPECT_LT(glm::distance(still.camera.position, turned.camera.position), 1e-4f);
    EXPECT_LT(glm::distance(still.camera.back, turned.camera.back), 1e-5f);
    const vec3 was = still.scene.meshes[0].positions[1], centre(0.5f, 0, 0);
    const vec3 is = turned.scene.meshes[0].positions[1];
    EXPECT_LT(glm::distance(is, vec3(centre.x + was.z, was.y, -(was.x - centre.x))), 1e-5f);
  }
}

// Under a uniform probe, a turn of the model shows what a turn of the camera the other way shows.
TEST(Stand, ATurntableIsAnOrbitTheOtherWay) {
  const Model model;
  const auto seen = [&](const std::string& name, const std::string& degrees) {
    const LoadedScene loaded = model.load({{name, degrees}});
    const CameraView view(loaded.camera, 1.5);
    return view.at(glm::dvec3(loaded.scene.meshes[0].positions[1]))->position;
  };
  EXPECT_LT(glm::distance(seen("turntable", "50"), seen("orbit", "-50")), 1e-4);
  EXPECT_GT(glm::distance(seen("turntable", "50"), seen("turntable", "0")), 0.02);
}

// Each frame of a turntable is the still at its angle.
TEST(Stand, FramesOfATurntableAreStills) {
  const Model model;
  std::ofstream(model.path()) << "model = \"model.gltf\"\n[probe]\nfile = \"" << kProbe << "\"\n";
  const TemporaryFolder out;
  const std::vector<std::string> common{"render",    model.path(), "--size",   "12x8",
                                        "--samples", "2",          "--ground", "--quiet"};
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), common.begin(), common.end());
    const CommandResult result = runCommand(more);
    ASSERT_EQ(result.status, 0) << result.error;
  };
  run({"--frames", "0:3", "--turntable", "360", "-o", out / "frame.#.exr"});
  for (const int i : {0, 1, 3}) {
    const std::string n = std::to_string(i);
    run({"--turntable", std::to_string(90 * i), "--animation-time", std::to_string(i / 24.0), "-o",
         out / ("still." + n + ".exr")});
    EXPECT_EQ(readImage(out / ("frame." + n + ".exr")).texels,
              readImage(out / ("still." + n + ".exr")).texels)
        << i;
  }
  EXPECT_NE(readImage(out / "frame.0.exr").texels, readImage(out / "frame.1.exr").texels);
}

TEST(Stand, TheWholeAnimationIsInViewAtEachOfItsTimes) {
  const Model model;
  const Camera start = model.load({{"model.time", "0"}}).camera,
               end = model.load({{"model.time", "1"}}).camera;
  EXPECT_EQ(start.position, end.position);
  const CameraView view(start, 800.0 / 600);
  for (const double y : {-1.0, 5.0}) {
    const auto at = view.at({0, y, 0});
    EXPECT_TRUE(at && at->position.y > 0 && at->position.y < 1) << y;
  }
}

TEST(Stand, AViewTakesThePlaceOfTheModelsAndTheFilesCamera) {
  const Model model(true);
  EXPECT_EQ(model.load({}).camera.node, "front");
  const Given right{{"camera.view", "90,0"}};
  EXPECT_NEAR(model.load(right).camera.back.x, 1, 1e-6);
  const std::string placed = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nfov = 10\n";
  const Camera framed = model.load(right, placed).camera;
  EXPECT_NEAR(framed.back.x, 1, 1e-6);
  EXPECT_NEAR(framed.fov, glm::radians(47.0), 1e-5);
  EXPECT_NEAR(model.load({}, "[camera]\nview = [0, 90]\n").camera.back.y, 1, 1e-6);
  const LoadedScene node = model.load({{"camera.look_at_node", "stays"}});
  EXPECT_GT(node.camera.position.y, 3.9f);
}

// Also where the principal point is not in the middle.
TEST(Stand, ZoomEnlargesTheMiddleOfTheImage) {
  const Model model;
  const std::string shifted =
      "[camera]\nposition = [0, 4, 5]\nlook_at = [0, 4, 0]\nprincipal_point = [0.25, 0.6]\n";
  const auto directionAt = [&](const Given& given, double u, double v) {
    vec3 origin, direction;
    CameraRays(model.load(given, shifted).camera, 1).ray(float(u), float(v), origin, direction);
    return direction;
  };
  for (const double u : {0.0, 0.5, 1.0})
    for (const double v : {0.2, 0.5})
      EXPECT_LT(glm::distance(directionAt({{"camera.zoom", "4"}}, u, v),
                              directionAt({}, 0.5 + (u - 0.5) / 4, 0.5 + (v - 0.5) / 4)),
                1e-5f);
}

// A camera that turns around a node, or a model that turns in front of it, keeps the node in view.
TEST(Stand, ANodeToBeLookedAtStaysInViewOfTurns) {
  GltfWriter w;
  addTriangle(w, {}, {{"name", "far"}, {"translation", {0, 0, -6}}});
  addTriangle(w, {}, {{"name", "near"}, {"translation", {2, 0, 6}}});
  w.save();
  const std::string path = (w.folder() / "scene.toml").string();
  for (const char* turn : {"orbit", "turntable"})
    for (int degrees = 0; degrees < 360; degrees += 45) {
      std::ofstream(path) << "model = \"model.gltf\"\n";
      Settings settings;
      settings.parse("probe.file", kProbe);
      settings.parse("camera.look_at_node", "near");
      settings.parse("camera.view", "0,0");
      settings.parse("render.size", "64x64");
      settings.parse(turn, std::to_string(degrees));
      const LoadedScene loaded = loadScene(planRender(openScene(path), settings));
      const Scene& scene = loaded.scene;
      const Camera& camera = loaded.camera;
      for (const int i : instancesBelow(scene, "near")) {
        const Instance& instance = scene.instances[size_t(i)];
        for (const vec3& p : scene.meshes[size_t(instance.mesh)].positions) {
          const vec3 q = instance.point(p) - camera.position;
          const float limit = -glm::dot(q, camera.back) * std::tan(0.5f * camera.fov);
          EXPECT_LT(std::fabs(glm::dot(q, camera.right)), limit) << turn << " " << degrees;
          EXPECT_LT(std::fabs(glm::dot(q, camera.up)), limit) << turn << " " << degrees;
        }
      }
    }
}

TEST(Stand, FieldOfViewAndZoomAreOfAnyCamera) {
  const Model model(true);
  const auto fovOf = [&](const Given& given, const std::string& more = "") {
    return glm::degrees(double(model.load(given, more).camera.fov));
  };
  const std::string placed = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
  for (const std::string& camera : {std::string(), placed}) {
    EXPECT_NEAR(fovOf({{"camera.fov", "20"}}, camera), 20, 1e-4);
    const double whole = std::tan(glm::radians(fovOf({}, camera)) / 2),
                 half = std::tan(glm::radians(fovOf({{"camera.zoom", "2"}}, camera)) / 2);
    EXPECT_NEAR(half, whole / 2, 1e-5);
  }
  EXPECT_NEAR(fovOf({}, placed + "fov = 33\n"), 33, 1e-4);
  EXPECT_NEAR(fovOf({}, "[camera]\nname = \"front\"\nfov = 33\n"), 33, 1e-4);
  std::ofstream(model.w.folder() / "camera.toml") << placed;
  const std::string file = "[camera]\nfile = \"camera.toml\"\n";
  EXPECT_NEAR(fovOf({}, file + "fov = 33\n"), 33, 1e-4);
  EXPECT_NEAR(fovOf({{"camera.fov", "20"}}, file + "fov = 33\n"), 20, 1e-4);
  EXPECT_NEAR(fovOf({}, "[camera]\nfov = 33\nview = [10, 20]\n"), 33, 1e-4);
}

TEST(Stand, RefusesWhatDoesNotGoTogether) {
  const Model model(true);
  const auto refused = [&](const Given& given, const std::string& more, const std::string& reason) {
    try {
      model.load(given, more);
      ADD_FAILURE() << reason;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  refused({{"camera.view", "0,0"}, {"camera.name", "front"}}, "", "excludes");
  refused({}, "[camera]\nname = \"front\"\nview = [0, 0]\n", "it cannot have `view` too");
  refused({}, "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nlook_at_node = \"falls\"\n",
          "it cannot have `look_at_node` too");
  refused({}, "[camera]\nview = [20, 10]\nup = [0, 0, 1]\n",
          "[camera] has `view`; it cannot have `up` too");
  refused({{"camera.view", "0,91"}}, "", "from -90 to 90");
  refused({{"camera.look_at_node", "stay"}}, "", "did you mean `stays`");
  refused({{"camera.look_at_node", "front"}}, "", "no surface");
  refused({{"turntable", "3"}, {"camera.shutter", "1"}}, "", "while the shutter is open");
  refused({{"camera.fov", "30"}},
          "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\northographic = 2\n",
          "no field of view");
}

// A cube of single-sided walls that face inwards.
TEST(Stand, ClosedRoomsLetTheProbesLightIn) {
  GltfWriter w;
  const std::vector<float> corners{0, 0, 0, 4, 0, 0, 0, 4, 0, 4, 4, 0,
                                   0, 0, 4, 4, 0, 4, 0, 4, 4, 4, 4, 4};
  const std::vector<uint16_t> inwards{0, 1, 2, 1, 3, 2, 4, 6, 5, 5, 6, 7, 0, 2, 4, 2, 6, 4,
                                      1, 5, 3, 3, 5, 7, 0, 4, 1, 1, 4, 5, 2, 3, 6, 3, 7, 6};
  const int mesh =
      w.mesh({{"attributes", {{"POSITION", w.vec3s(corners)}}}, {"indices", w.indices(inwards)}});
  w.add("scenes", {{"nodes", {w.add("nodes", {{"mesh", mesh}})}}});
  const std::string path = w.save();
  const auto sides = [&](const Given& given) {
    Settings settings;
    for (const auto& [name, text] : given) settings.parse(name, text);
    settings.parse("probe.file", kProbe);
    return loadScene(planRender(openScene(path), settings));
  };
  const auto says = [](const LoadedScene& loaded) {
    return std::ranges::any_of(loaded.messages, [](const Message& m) {
      return m.text.find("passes the backs") != std::string::npos;
    });
  };
  const LoadedScene chosen = sides({});
  EXPECT_EQ(chosen.description.singleSided, SingleSided::Light);
  EXPECT_EQ(chosen.scene.materials[0].singleSided, SingleSided::Light);
  EXPECT_TRUE(says(chosen));
  const LoadedScene given = sides({{"render.single_sided", "camera"}});
  EXPECT_EQ(given.description.singleSided, SingleSided::Camera);
  EXPECT_FALSE(says(given));
}

}  // namespace
}  // namespace chromeball::stand_test
