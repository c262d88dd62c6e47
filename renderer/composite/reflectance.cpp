// SPDX-License-Identifier: Apache-2.0
#include "composite/reflectance.h"

#include <map>

namespace chromeball {
namespace {

constexpr Rgb kFirstGuess(0.25f);       // typical of real surfaces
constexpr uint32_t kSightSamples = 16;  // a pixel, to find what the camera sees
constexpr uint32_t kMaxSamples = 1024;

// What is seen of the local scene: how far away, and the model's own base colour.
struct Sight {
  Image farthest, baseColor;  // 0 where nothing is seen
};

class SightIntegrator : public Integrator {
 public:
  SightIntegrator(const Accel& rays, const CameraRays& camera, Sight& sight)
      : scene_(rays.scene()), rays_(rays), camera_(camera), sight_(sight) {}

  Sample sample(const CameraSample& camera, PathMemory& memory, FirstHit*) const override {
    memory.sampler.startVertex(0);
    PathState state = camera.path();
    const auto hit = passUnseen(scene_, rays_, state, camera.hit, memory.sampler);
    if (!hit) return Rgb(0);
    const vec3& direction = state.ray.direction;
    const Surface surface = surfaceAt(scene_, scene_.instances[hit->instance], hit->triangle,
                                      hit->barycentric, -direction);
    float& farthest = *sight_.farthest.at(camera.x, camera.y);
    const float distance = glm::length(surface.position - camera.ray.origin);
    farthest = std::max(farthest, camera_.depth(direction, distance));
    sight_.baseColor.setRgb(camera.x, camera.y, materialAt(scene_, surface).baseColor);
    return Rgb(0);
  }

 private:
  const Scene& scene_;
  const Accel& rays_;
  const CameraRays& camera_;
  Sight& sight_;
};

// Radiance of the local scene, of which the surface that the camera sees has another base colour.
class RepaintedIntegrator : public Integrator {
 public:
  RepaintedIntegrator(const PathScene<LocalRays>& path, const Rgb& baseColor)
      : path_(path), baseColor_(baseColor) {}

  Sample sample(const CameraSample& camera, PathMemory& memory, FirstHit* first) const override {
    ++memory.rays.camera;
    memory.sampler.startVertex(0);
    PathState state = camera.path();
    const auto hit = passUnseen(path_.scene, path_.rays, state, camera.hit, memory.sampler);
    if (!hit) return Rgb(0);
    const Instance& instance = path_.scene.instances[hit->instance];
    state.length += hit->distance;
    const Surface surface =
        surfaceAt(path_.scene, instance, hit->triangle, hit->barycentric, -state.ray.direction);
    Rgb found(0);
    if (surface.material->emits()) found += foundEmission(path_, state, surface, instance);
    MaterialPoint material = materialAt(path_.scene, surface);
    material.baseColor = baseColor_;
    if (first) first->hit = true;
    const Bsdf bsdf(material, surface, -state.ray.direction, path_.mirrorAlpha);
    if (!scatter<false>(path_, state, surface, bsdf, memory.sampler, memory.samples, memory.rays,
                        found))
      return found;
    memory.sampler.startVertex(state.depth);
    return found + followPath(path_, state, closestHit(path_.rays, state.ray, memory.sampler),
                              memory.sampler, memory.samples, memory.rays, nullptr);
  }

 private:
  const PathScene<LocalRays>& path_;
  Rgb baseColor_;
};

ObjectMask inverse(ObjectMask mask) {
  mask.flip();
  return mask;
}

// Applies `change` to the materials of the local scene, after making them its own.
template <class Change>
void changeLocalMaterials(Scene& scene, const ObjectMask& isObject, const Change& change) {
  std::map<int, int> copies;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    if (isObject[i]) continue;
    int& material = scene.instances[i].material;
    const auto [copy, isNew] = copies.try_emplace(material, int(scene.materials.size()));
    if (isNew) {
      scene.materials.push_back(scene.materials[size_t(material)]);
      change(scene.materials.back());
    }
    material = copy->second;
  }
}

Sight look(const ReflectanceProblem& problem, const Accel& local, const RenderSettings& settings,
           const std::atomic<bool>& stop) {
  Sight sight{Image(settings.width, settings.height, 1), Image(settings.width, settings.height, 3)};
  RenderSettings quick;
  quick.width = settings.width, quick.height = settings.height;
  quick.samples = kSightSamples;
  quick.maxDepth = 0;
  quick.seed = settings.seed;
  const CameraRays camera(problem.camera, float(settings.width) / float(settings.height));
  render(
      SightIntegrator(local, camera, sight), local, problem.camera, quick, [](double) {}, stop);
  return sight;
}

// Mean radiance of what is seen of the local scene where that has the base colour given.
Image repainted(const PathScene<LocalRays>& path, const Rgb& baseColor, const Camera& camera,
                const RenderSettings& settings, const Progress& progress,
                const std::atomic<bool>& stop) {
  const RenderResult result = render(RepaintedIntegrator(path, baseColor), path.rays.local, camera,
                                     settings, progress, stop);
  Image image = result.film.mean();
  const Image alpha = result.aovs.finished(Aov::Alpha);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (const float fraction = *alpha.at(x, y); fraction > 0)
        image.setRgb(x, y, image.rgb(x, y) / fraction);
  return image;
}

// One step of the solution, from the radiance of black and of white surfaces.
ReflectanceSolution explain(const Image& plate, const Image& black, const Image& white,
                            const Sight& sight, Projection& projection) {
  constexpr float kDark = 1e-4f;  // of the mean, below which there is no light to speak of
  ReflectanceSolution solution;
  double light = 0, plateSum = 0, modelSum = 0;
  const auto forSeen = [&](const auto& visit) {
    for (int y = 0; y < plate.height; ++y)
      for (int x = 0; x < plate.width; ++x)
        if (*sight.farthest.at(x, y) > 0) visit(x, y);
  };
  forSeen([&](int x, int y) {
    light += luminance(white.rgb(x, y) - black.rgb(x, y));
    ++solution.pixels;
  });
  if (solution.pixels == 0) return solution;
  const float dark = kDark * float(light / double(solution.pixels));
  forSeen([&](int x, int y) {
    const Rgb wanted = plate.rgb(x, y) - black.rgb(x, y);
    const Rgb received = white.rgb(x, y) - black.rgb(x, y), model = sight.baseColor.rgb(x, y);
    Rgb rho = model;
    for (int c = 0; c < 3; ++c)
      if (received[c] > dark) rho[c] = wanted[c] / received[c];
    solution.clamped += maxComponent(rho) > 1;
    rho = glm::clamp(rho, 0.0f, 1.0f);
    solution.lastChange +=
        luminance(glm::abs(rho - projection.colors().rgb(x, y))) / double(solution.pixels);
    projection.colors().setRgb(x, y, rho);
    plateSum += luminance(plate.rgb(x, y));
    modelSum += luminance(black.rgb(x, y) + model * received);
  });
  solution.exposureRatio = modelSum > 0 ? plateSum / modelSum : 0;
  return solution;
}

void startFrom(const Sight& sight, const Rgb& guess, Projection& projection) {
  projection.setDepth(sight.farthest);
  Image& colors = projection.colors();
  for (int y = 0; y < colors.height; ++y)
    for (int x = 0; x < colors.width; ++x)
      colors.setRgb(x, y, *sight.farthest.at(x, y) > 0 ? guess : Rgb(0));
}

}  // namespace

void makeProjected(Scene& scene, const ObjectMask& isObject, const Projection& projection) {
  changeLocalMaterials(scene, isObject, [&](Material& m) {
    m.projection = &projection;
    m.extended.reset();
    m.metallic = 0;
    m.specular = 0;
  });
}

void makeGlossy(Scene& scene, const ObjectMask& isObject, float strength, float roughness) {
  changeLocalMaterials(scene, isObject, [&](Material& m) {
    m.extended.reset();
    m.metallic = 0;
    m.specular = strength;
    m.specularColor = Rgb(1);
    m.ior = 1.5f;
    m.roughness = roughness;
    m.metallicRoughnessTexture = m.specularTexture = m.specularColorTexture = {};
  });
}

ReflectanceSolution solveReflectance(const ReflectanceProblem& problem,
                                     const RenderSettings& settings, int iterations,
                                     Projection& projection, const Progress& progress,
                                     const std::atomic<bool>& stop) {
  const Accel local(problem.scene, inverse(problem.isObject));
  const Sight sight = look(problem, local, settings, stop);
  startFrom(sight, kFirstGuess, projection);

  RenderSettings step = settings;
  step.aovs = {Aov::Alpha};
  step.samples = std::min(settings.samples, kMaxSamples);
  step.timeLimit.reset();
  step.noiseLimit.reset();
  const std::unique_ptr<Emitters> emitters = Emitters::make(problem.scene);
  const LocalRays rays{local, problem.isObject};
  const std::unique_ptr<PunctualLights> punctual = PunctualLights::make(problem.scene);
  PathScene<LocalRays> path{problem.scene,     rays, problem.lighting, emitters.get(), settings.mis,
                            settings.maxDepth, true, punctual.get()};
  path.maxTransmissionDepth = settings.maxTransmissionDepth;
  path.measuresCut = false;
  prepareBsdfs(problem.scene);
  bool shines = false;  // also where it is black
  for (size_t i = 0; i < problem.isObject.size(); ++i) {
    const Material& m = problem.scene.materials[problem.scene.instances[i].material];
    shines |= !problem.isObject[i] && (m.emits() || m.specular > 0);
  }

  ReflectanceSolution solution;
  for (int i = 0; i < iterations && !stop; ++i) {
    const auto report = [&](double fraction) { progress((i + fraction) / iterations); };
    Image black(settings.width, settings.height, 3);
    if (shines) black = repainted(path, Rgb(0), problem.camera, step, report, stop);
    const Image white = repainted(path, Rgb(1), problem.camera, step, report, stop);
    solution = explain(problem.plate, black, white, sight, projection);
  }
  return solution;
}

ReflectanceSolution solveFlatReflectance(const ReflectanceProblem& problem,
                                         const RenderSettings& settings, const Rgb& irradiance,
                                         Projection& projection, const std::atomic<bool>& stop) {
  const Accel local(problem.scene, inverse(problem.isObject));
  const Sight sight = look(problem, local, settings, stop);
  startFrom(sight, kFirstGuess, projection);
  Image black(settings.width, settings.height, 3), white = black;
  for (int y = 0; y < white.height; ++y)
    for (int x = 0; x < white.width; ++x) white.setRgb(x, y, irradiance * kInvPi);
  return explain(problem.plate, black, white, sight, projection);
}

std::optional<vec3> flatNormal(const Scene& scene, const ObjectMask& isObject) {
  constexpr double kTolerance = 1e-4;  // of the scene's size, and of a unit normal
  std::optional<glm::dvec3> normal, point;
  double size = 0, farthest = 0;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    if (isObject[i]) continue;
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const Triangle& t : mesh.triangles) {
      glm::dvec3 p[3];
      for (int k = 0; k < 3; ++k) p[k] = glm::dvec3(instance.point(mesh.positions[t[k]]));
      glm::dvec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
      if (!(glm::length(n) > 0)) continue;
      n = glm::normalize(n);
      if (n.y < 0) n = -n;
      if (!normal) normal = n, point = p[0];
      if (glm::length(n - *normal) > kTolerance) return std::nullopt;
      for (const glm::dvec3& corner : p) {
        size = std::max(size, glm::length(corner - *point));
        farthest = std::max(farthest, std::abs(glm::dot(corner - *point, *normal)));
      }
    }
  }
  if (!normal || farthest > kTolerance * size) return std::nullopt;
  return vec3(*normal);
}

}  // namespace chromeball
