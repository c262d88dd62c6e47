// SPDX-License-Identifier: Apache-2.0
// A lighting strategy outside of the library, compared with built-in ones: directions in proportion
// to the cosine at the surface, pdf cos / pi.
#include <chromeball/render.h>

#include <cstdio>

using namespace chromeball;

class Cosine : public LightSource {
 public:
  explicit Cosine(const Probe& probe) : probe_(probe) {}

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override {
    const vec3 local = squareToCosineHemisphere(sampler.get2(dimension::kLight));
    const float pdf = local.z * kInvPi;
    if (!(pdf > 0)) return;
    const vec3 wi = Frame(point.normal).toWorld(local);
    out.push_back({.wi = wi, .irradiance = probe_.radiance(wi) / pdf, .pdf = pdf});
  }
  Escaped escaped(const LightPoint& point, const vec3& wi) const override {
    return {probe_.radiance(wi), std::max(glm::dot(point.normal, wi), 0.0f) * kInvPi};
  }
  Rgb background(const vec3&, const vec3& wi) const override { return probe_.radiance(wi); }
  bool unbiased() const override { return true; }

 private:
  const Probe& probe_;
};

Image rendered(const RenderDescription& description) {
  Session session(description);
  session.start();
  return session.wait().color();
}

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: strategy SCENE.toml\n"), 2;
  RenderDescription description = planRender(openScene(argv[1]));
  description.settings.samples = 4096;
  const Image reference = rendered(description);
  description.settings.samples = 16;
  description.settings.seed = 1;
  for (const char* name : {"uniform", "importance", "cosine"}) {
    description.lighting.strategy = name;
    if (name == std::string("cosine"))
      description.lighting.make = [](const Probe& probe, const glm::dvec3&) {
        return std::make_unique<Cosine>(probe);
      };
    std::printf("%s %.4g\n", name, imageError(rendered(description), reference).relMse);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
