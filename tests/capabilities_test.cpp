// SPDX-License-Identifier: Apache-2.0
// The table of features that cannot be combined.
#include "description/capabilities.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "base/error.h"

namespace chromeball::capabilities_test {
namespace {

using D = RenderDescription;

void composite(D& d, CompositeMode mode) {
  CompositeDescription& c = d.composite.emplace();
  c.mode = mode;
  c.ground = CompositeDescription::GroundPlane::Always;
}

// A description without conflicts.
D plain() {
  D d;
  d.lighting.strategy = "importance";
  d.probe.file = "sky.exr";
  return d;
}

// Changes that bring a feature into a description, by its name.
const std::map<std::string_view, std::function<void(D&)>> kBring = {
    {"a composite", [](D& d) { composite(d, CompositeMode::Ratio); }},
    {"a composite with a plate", [](D& d) { composite(d, CompositeMode::Difference); }},
    {"a shadow catcher", [](D& d) { composite(d, CompositeMode::ShadowCatcher); }},
    {"a reference of two passes",
     [](D& d) {
       if (!d.composite) composite(d, CompositeMode::Difference);
       d.composite->passes = Passes::Two;
     }},
    {"a clamp", [](D& d) { d.settings.clamp = 1.0f; }},
    {"an exposure that the picture decides", [](D& d) { d.output.choosesExposure = true; }},
    {"regularisation", [](D& d) { d.settings.regularize = true; }},
    {"denoising", [](D& d) { d.settings.denoise = true; }},
    {"layers to denoise later", [](D& d) { d.output.layers.push_back("denoise"); }},
    {"straight shadows of glass", [](D& d) { d.straightGlassShadows = true; }},
    {"a guide that is on", [](D& d) { d.settings.guiding = Guiding::On; }},
    {"visible lights of a strategy", [](D& d) { d.lighting.showLights = true; }},
    {"layers by light", [](D& d) { d.settings.lightGroups = true; }},
    {"ambient occlusion of an environment map", [](D& d) { d.settings.occlusion.ambient = true; }},
    {"occlusion of reflections", [](D& d) { d.settings.occlusion.reflection = true; }},
    {"a distance of occlusion", [](D& d) { d.settings.occlusion.distance = 1; }},
    {"uniform bent normals", [](D& d) { d.settings.occlusion.uniformBent = true; }},
    {"an integrator that follows no paths",
     [](D& d) { d.settings.integrator = IntegratorKind::EnvironmentMap; }},
    {"an irradiance cache", [](D& d) { d.settings.cacheError = 0.1f; }},
    {"a file of a cache", [](D& d) { d.run.cache = "a.cache"; }},
    {"finite surroundings", [](D& d) { d.surroundings.emplace(); }},
    {"sources in the probe", [](D& d) { d.sources.emplace_back(); }},
    {"lamps of the scene file", [](D& d) { d.lamps.emplace_back(); }},
    {"a part of the light", [](D& d) { d.lighting.from = LightFrom::Suns; }},
    {"limits of depth by kind", [](D& d) { d.settings.maxDiffuseDepth = 1; }},
    {"an open shutter", [](D& d) { d.camera.shutter.emplace(); }},
    {"a turned camera", [](D& d) { d.camera.orbit = 3; }},
    {"turned models", [](D& d) { d.stand.turntable = 3; }},
    {"dropped models", [](D& d) { d.stand.drops = true; }},
    {"a ground", [](D& d) { d.stand.hasGround = true; }},
    {"a composite that does not name the ground",
     [](D& d) { composite(d, CompositeMode::Difference); }},
    {"a scene from memory", [](D& d) { d.scene = std::make_shared<const Scene>(); }},
    {"a turn while the shutter is open", [](D& d) { d.origins.set("orbit-step", "--orbit-step"); }},
    {"frames per second", [](D& d) { d.origins.set("fps", "--fps"); }},
    {"a transparent background", [](D& d) { d.settings.hideProbe = true; }},
    {"a shard", [](D& d) { d.settings = shardOf(d.settings, 0, 2); }},
    {"a crop",
     [](D& d) {
       d.settings.crop = Crop{0, 0, 1, 1};
     }},
    {"a checkpoint", [](D& d) { d.run.checkpoint = "a.exr"; }},
    {"a time between checkpoints",
     [](D& d) { d.origins.set("checkpoint-every", "--checkpoint-every"); }},
    {"going on", [](D& d) { d.run.resumes = true; }},
    {"images while it renders", [](D& d) { d.run.writeEvery = 1.0; }},
    {"a preview", [](D& d) { d.origins.set("preview", "--preview"); }},
    {"a display", [](D& d) { d.origins.set("display", "--display"); }},
    {"a probe scaled by the plate", [](D& d) { d.probe.isScaledByPlate = true; }},
    {"no plate",
     [](D& d) {
       d.composite.reset();
       d.origins.set("two-pass", "--two-pass");
     }},
    {"no ground of a composite",
     [](D& d) {
       composite(d, CompositeMode::Difference);
       d.composite->ground = CompositeDescription::GroundPlane::Never;
     }},
    {"no probe's file",
     [](D& d) {
       composite(d, CompositeMode::Difference);
       d.probe.file.reset();
     }},
    {"another strategy than importance", [](D& d) { d.lighting.strategy = "uniform"; }},
    {"a strategy without light samples", [](D& d) { d.lighting.strategy = "bsdf"; }},
    {"a strategy without lights", [](D&) {}},
    {"one sample per pixel", [](D& d) { d.settings.samples = 1; }},
    {"another integrator than environment-map", [](D&) {}},
    {"another integrator than path", [](D& d) { d.settings.integrator = IntegratorKind::Direct; }},
    {"no ambient occlusion", [](D&) {}},
    {"no layer of bent normals", [](D&) {}},
    {"no irradiance cache", [](D&) {}},
    {"a closed shutter", [](D&) {}},
    {"neither frames nor a shutter", [](D&) {}},
    {"no checkpoint", [](D&) {}},
};

TEST(Capabilities, APlainDescriptionHasNoConflict) {
  const D d = plain();
  EXPECT_EQ(conflictIn(d), nullptr);
  EXPECT_NO_THROW(checkCapabilities(d));
}

// Every row is refused when both features are there, but not with one alone (except for missing
// features).
TEST(Capabilities, EveryConflictIsFound) {
  std::set<std::string_view> used;
  for (const Conflict& c : conflicts()) {
    const std::string what = fmt::format("{} and {}", c.feature.name, c.with.name);
    ASSERT_TRUE(kBring.contains(c.feature.name)) << c.feature.name;
    ASSERT_TRUE(kBring.contains(c.with.name)) << c.with.name;
    used.insert({c.feature.name, c.with.name});
    D d = plain();
    if (c.feature.name == "a probe scaled by the plate" && !d.composite)
      composite(d, CompositeMode::Difference);
    kBring.at(c.feature.name)(d);
    kBring.at(c.with.name)(d);
    EXPECT_TRUE(c.feature.isIn(d)) << what;
    EXPECT_TRUE(c.with.isIn(d)) << what;
    const Conflict* found = conflictIn(d);
    ASSERT_TRUE(found) << what;
    d.origins.set(std::string(found->feature.setting), "scene.toml:7");
    try {
      checkCapabilities(d);
      ADD_FAILURE() << what;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), fmt::format("scene.toml:7: {}", found->why));
    }
  }
  EXPECT_EQ(used.size(), kBring.size()) << "a feature is in no row";
}

// Of a description from memory, whose numbers no reader of text has checked.
TEST(Capabilities, NumbersOutOfRangeAreRefused) {
  EXPECT_NO_THROW(checkNumbers(plain()));
  const std::map<std::string, std::vector<std::function<void(D&)>>> bad = {
      {"render.size",
       {[](D& d) {
          d.size = ImageSize{0, 10};
        },
        [](D& d) {
          d.size = ImageSize{10, -1};
        }}},
      {"render.samples", {[](D& d) { d.settings.samples = 0; }}},
      {"render.noise",
       {[](D& d) { d.settings.noiseLimit = NAN; }, [](D& d) { d.settings.noiseLimit = -1; }}},
      {"render.time", {[](D& d) { d.settings.timeLimit = -1; }}},
      {"clamp", {[](D& d) { d.settings.clamp = -1.0f; }}},
      {"render.max_depth",
       {[](D& d) { d.settings.maxDepth = -1; }, [](D& d) { d.settings.maxSpecularDepth = -1; }}},
      {"lighting.lights", {[](D& d) { d.lighting.lamps = INFINITY; }}},
      {"orbit", {[](D& d) { d.camera.orbit = NAN; }}},
      {"turntable", {[](D& d) { d.stand.turntable = INFINITY; }}},
      {"render.ground", {[](D& d) { d.stand.height = NAN; }}},
      {"camera.view", {[](D& d) { d.camera.view.emplace().roll = NAN; }}},
      {"camera.zoom", {[](D& d) { d.camera.zoom = 0; }, [](D& d) { d.camera.zoom = INFINITY; }}},
      {"camera.fov",
       {[](D& d) { d.camera.placed.emplace().lens.fov = 4; }, [](D& d) { d.camera.fov = 180; },
        [](D& d) { d.camera.placed.emplace().lens.fov = 0; },
        [](D& d) { d.camera.placed.emplace().lens.fov = NAN; }}},
      {"camera.aperture", {[](D& d) {
         d.camera.lens = Lens{-0.6f, 1};
       }}},
      {"camera.focus", {[](D& d) {
         d.camera.lens = Lens{0.1f, 0};
       }}}};
  for (const auto& [setting, changes] : bad)
    for (const auto& change : changes) {
      D d = plain();
      change(d);
      try {
        checkNumbers(d);
        ADD_FAILURE() << setting;
      } catch (const InputError& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with(setting + ": should ")) << error.what();
      }
    }
}

// Every row is reported if its setting was given without what it needs: alone for some scene, and
// never for one that has everything.
TEST(Capabilities, EverySettingInVainIsNamed) {
  D open = plain();
  open.camera.shutter.emplace();
  open.lighting.strategy = "suns";
  open.settings.maxDiffuseDepth = open.settings.maxSpecularDepth = 2;
  D inVain = plain();
  inVain.probe.file.reset();
  inVain.straightGlassShadows = true;
  inVain.singleSided = SingleSided::Off;
  inVain.lighting.from = LightFrom::Rest;
  inVain.settings.regularize = true;
  inVain.settings.guiding = Guiding::On;
  inVain.settings.integrator = IntegratorKind::Direct;
  inVain.settings.cacheError = 0.1f;
  composite(inVain, CompositeMode::Difference);
  D mapped = plain();
  mapped.settings.integrator = IntegratorKind::EnvironmentMap;
  mapped.settings.occlusion.ambient = mapped.settings.occlusion.reflection = true;
  D flat = plain();  // no bounces
  flat.settings.maxDepth = 0;
  D delta = plain();
  delta.lighting.strategy = "median-cut:8";
  D suns = plain();
  suns.lighting.strategy = "suns";
  D ofSuns = plain();
  ofSuns.lighting.from = LightFrom::Suns;
  D inMemory = plain();
  inMemory.probe.file.reset();
  inMemory.probe.map = std::make_shared<const Image>(2, 1, 3);
  const SceneContents nothing, probe{.hasProbe = true},
      all{true, true, true, true, true, true, true, true, true, true};
  for (const Dependence& d : dependences()) {
    const std::string name(d.setting);
    std::vector<std::vector<std::string>> told;
    for (D* description : {&open, &inVain, &mapped, &flat, &delta, &suns, &ofSuns, &inMemory})
      for (const SceneContents& contents : {nothing, probe, all}) {
        EXPECT_EQ(idleSettings(*description, contents), std::vector<std::string>{}) << name;
        description->origins.set(name, "scene.toml:7");
        told.push_back(idleSettings(*description, contents));
        description->origins = {};
      }
    open.origins.set(name, "scene.toml:7");
    EXPECT_EQ(idleSettings(open, all), std::vector<std::string>{}) << name;
    open.origins = {};
    const std::vector<std::string> line{
        fmt::format("scene.toml:7: `{}` has no effect without {}", name, d.needs)};
    EXPECT_GT(std::ranges::count(told, line), 0) << line[0];
  }
}

// Frames per second are of frames, or of a shutter, also of one that is closed.
TEST(Capabilities, FramesPerSecondNeedAUse) {
  D d = plain();
  d.origins.set("fps", "--fps");
  EXPECT_TRUE(conflictIn(d));
  d.run.isOfFrames = true;
  EXPECT_FALSE(conflictIn(d));
  d.run.isOfFrames = false;
  d.origins.set("camera.shutter", "--shutter");
  EXPECT_FALSE(conflictIn(d));
}

// Bounces in glass are counted apart from those that a limit of one bounce leaves.
TEST(Capabilities, RegularizationWidensGlassAlsoOfOneBounce) {
  D d = plain();
  d.settings.integrator = IntegratorKind::Direct;
  d.settings.regularize = true;
  d.origins.set("render.regularize", "scene.toml:7");
  EXPECT_EQ(idleSettings(d, {.hasProbe = true}).size(), 1u);
  EXPECT_TRUE(idleSettings(d, {.hasProbe = true, .hasBodies = true}).empty());
}

// A row says a thing once: no two rows have the same features, in either order.
TEST(Capabilities, NoConflictIsThereTwice) {
  std::set<std::set<std::string_view>> pairs;
  for (const Conflict& c : conflicts())
    EXPECT_TRUE(pairs.insert({c.feature.name, c.with.name}).second)
        << c.feature.name << " and " << c.with.name;
}

}  // namespace
}  // namespace chromeball::capabilities_test
