// SPDX-License-Identifier: Apache-2.0
#include "integrate/environment_light.h"

#include <array>
#include <set>

#include "lighting/scene_suns.h"
#include "probe/sun_extraction.h"

namespace chromeball {
namespace {

// alpha = roughness^2 doubles from each to the next.
constexpr std::array kLadder = {PrefilteredProbe::kLeastRoughness, 0.28f, 0.4f, 0.57f, 0.8f};
constexpr float kGreatest = 0.98f;  // beyond, the diffuse map is as good

// The roughness of the material itself; if a texture varies it, also the steps below.
void addRoughness(float roughness, bool isTextured, std::set<float>& all) {
  if (roughness >= PrefilteredProbe::kLeastRoughness && roughness < kGreatest)
    all.insert(roughness);
  if (!isTextured) return;
  for (const float step : kLadder)
    if (step < roughness) all.insert(step);
}

std::vector<float> roughnessesOf(const Scene& scene) {
  constexpr size_t kMaxExact = 16;
  std::set<float> all;
  for (const Material& m : scene.materials) {
    if (m.unlit) continue;
    if (m.metallic > 0 || m.specular > 0) addRoughness(m.roughness, m.hasRoughnessTexture(), all);
    if (m.extended && m.extended->clearcoat > 0)
      addRoughness(m.extended->clearcoatRoughness, bool(m.extended->clearcoatRoughnessTexture),
                   all);
  }
  if (all.size() > kMaxExact) all = {kLadder.begin(), kLadder.end()};
  return {all.begin(), all.end()};
}

}  // namespace

struct EnvironmentLight::Parts {
  std::unique_ptr<const LightSource> suns;
  Probe sharp;

  Parts(const Probe& probe, bool splitsSuns, std::optional<double> sunAngle) : sharp(probe) {
    if (!splitsSuns) return;
    SunExtraction extraction = extractSuns(probe.latLong());
    if (extraction.suns.empty()) return;
    std::vector<SunLamp> lamps;
    for (Sun& sun : extraction.suns) {
      sun.angle = sunAngle.value_or(sun.angle);
      sun.direction = probe.rotation()(sun.direction);
      lamps.push_back({sun, true, "sun"});
    }
    suns = std::make_unique<SceneSuns>(lamps);
    sharp = Probe(extraction.remainder, probe.rotation());
  }
};

EnvironmentLight::EnvironmentLight(const Probe& probe, const Scene& scene, bool splitsSuns,
                                   std::optional<double> sunAngle)
    : EnvironmentLight(Parts(probe, splitsSuns, sunAngle), scene) {}

EnvironmentLight::EnvironmentLight(Parts parts, const Scene& scene)
    : suns_(std::move(parts.suns)),
      sharp_(std::move(parts.sharp)),
      maps_(sharp_, roughnessesOf(scene)) {}

}  // namespace chromeball
