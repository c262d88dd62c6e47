// SPDX-License-Identifier: Apache-2.0
#include "approximate/environment_map.h"

#include <array>
#include <set>

#include "lighting/scene_sources.h"
#include "math/vec.h"
#include "probe/sun_extraction.h"
#include "shading/ggx.h"
#include "trace/accel.h"
#include "transport/first_surface.h"

namespace chromeball {
namespace {

// alpha = roughness^2 doubles from step to step.
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

namespace {

// Light samples alone find the light of sources.
PathSettings withoutMis(PathSettings settings) {
  settings.mis = Mis::Off;
  settings.estimateDepthCut = false;
  return settings;
}

// A direction whose light microfacets reflect along wo; their normals are around the bisector of wo
// and the middle of the lobe.
vec3 reflectedBy(const MapLobe& lobe, const vec3& wo, vec2 u) {
  const float alpha = lobe.roughness * lobe.roughness;
  if (alpha < kSmoothAlpha) return lobe.direction;
  const Frame frame(glm::normalize(wo + lobe.direction));
  const vec3 local = frame.toLocal(wo);
  const vec3 h = ggx::sampleVisibleNormal(local, alpha, u);
  return frame.toWorld(2 * glm::dot(local, h) * h - local);
}

}  // namespace

struct EnvironmentMapIntegrator::Point {
  const FirstSurface& first;
  const PathState& state;
  const Bsdf& bsdf;
  Vertex vertex;
};

EnvironmentMapIntegrator::EnvironmentMapIntegrator(const World& world, const LightSource& lighting,
                                                   const EnvironmentLight& environment,
                                                   const PathSettings& settings,
                                                   const Occlusion& occlusion)
    : environment_(environment),
      occlusion_(occlusion),
      tracer_(world, lighting, withoutMis(settings)),
      direct_(world, lighting, tracer_.settings()) {
  if (const LightSource* suns = environment.suns())
    directSuns_.emplace(world, *suns, tracer_.settings());
}

Sample EnvironmentMapIntegrator::sample(const CameraSample& camera, PathContext& context) const {
  ++context.counts.camera;
  PathState state = camera.path();
  Rgb radiance(0);
  const auto first = firstReflector(tracer_, state, camera.hit, context, radiance);
  if (!first) return context.clamp(radiance);
  const Bsdf bsdf = first->bsdf(tracer_, state);
  const GuidedBsdf guided(bsdf, first->surface.position, -state.ray.direction, nullptr);
  const LightPoint light{first->surface.position, bsdf.normal(),      &bsdf, 0,
                         bsdf.transmits(),        first->surface.time};
  const Point point{
      *first, state, bsdf, {light, first->surface, guided, state.media, nullptr, state.throughput}};
  radiance += ofSources(point, context) + ofProbe(point, context);
  return context.clamp(radiance);
}

Rgb EnvironmentMapIntegrator::ofSources(const Point& point, PathContext& context) const {
  Rgb sum(0);
  for (size_t i = 0; i < tracer_.world().sources.all.size(); ++i)
    sum += direct_.ofScene(i, point.vertex, context);
  if (directSuns_) sum += directSuns_->probe(point.vertex, context);
  return sum;
}

// The radiance of sources that light samples do not find: for a smooth lobe, of all that it sees;
// else the light that no light sample has a pdf for, which is the same from all directions
// (scene_sources.h).
Rgb EnvironmentMapIntegrator::unsampled(const Point& point, const MapLobe& lobe) const {
  const bool isSmooth = !lobe.isDiffuse && lobe.roughness == 0;
  Rgb sum(0);
  const auto add = [&](const LightSource& source) {
    if (isSmooth) {
      sum += source.background(point.first.surface.position, lobe.direction);
    } else if (const auto found = source.escaped(point.vertex.point, lobe.direction);
               found.pdf == 0) {
      sum += found.radiance;
    }
  };
  const SceneSources& sources = tracer_.world().sources;
  for (const size_t i : sources.distant) add(*sources.all[i]);
  if (environment_.suns()) add(*environment_.suns());
  return sum;
}

Rgb EnvironmentMapIntegrator::diffuse(const Point& point, const MapLobe& lobe,
                                      PathContext& context) const {
  const Rgb radiance =
      environment_.maps().irradiance(lobe.direction) * kInvPi + unsampled(point, lobe);
  if (!occlusion_.ambient) return radiance;
  return radiance * cosineSkyRay(tracer_.world(), point.first.surface, lobe.direction,
                                 occlusion_.distance, tracer_.settings().visible, context)
                        .transmittance;
}

Rgb EnvironmentMapIntegrator::specular(const Point& point, const MapLobe& lobe,
                                       PathContext& context) const {
  const Surface& surface = point.first.surface;
  const PrefilteredProbe& maps = environment_.maps();
  const bool isTransmitted = glm::dot(surface.geometricNormal, lobe.direction) <= 0;
  const bool isSampled =
      !isTransmitted && lobe.roughness > 0 && lobe.roughness < PrefilteredProbe::kLeastRoughness;
  const bool isBlocked = !isTransmitted && occlusion_.reflection;
  vec3 wi = lobe.direction;
  if (isSampled || isBlocked)
    wi = reflectedBy(lobe, -point.state.ray.direction, context.sampler.get2(dimension::kBsdf));
  const Rgb radiance =
      (isSampled ? maps.radiance(wi, 0) : maps.radiance(lobe.direction, lobe.roughness)) +
      unsampled(point, lobe);
  if (!isBlocked) return radiance;
  if (glm::dot(surface.geometricNormal, wi) <= 0) return Rgb(0);
  ++context.counts.shadow;
  return radiance *
         tracer_.world().accel.transmittance(rayFrom(surface, wi), tracer_.settings().visible);
}

Rgb EnvironmentMapIntegrator::ofProbe(const Point& point, PathContext& context) const {
  Rgb sum(0);
  for (const MapLobe& lobe : point.bsdf.mapLobes())
    sum += lobe.albedo *
           (lobe.isDiffuse ? diffuse(point, lobe, context) : specular(point, lobe, context));
  return sum;
}

}  // namespace chromeball
