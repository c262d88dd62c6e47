// SPDX-License-Identifier: Apache-2.0
#include "python_light.h"

#include <mutex>

#include "arrays.h"
#include "base/error.h"
#include "base/parallel.h"
#include "lighting/probe_light.h"

namespace chromeball::python {
namespace {

ArrayIn<float> arrayFrom(const nb::handle& value) { return nb::cast<ArrayIn<float>>(value); }

// Calls the strategy for many points at once, in one thread at a time. It chooses the directions;
// the light from there is the probe's as the scene turns and scales it, without its sources, which
// all other rays find too.
class PythonLight : public ProbeLight {
 public:
  PythonLight(const Probe& probe, const glm::dvec3& origin, nb::handle strategy)
      : ProbeLight(probe), origin_(origin), strategy_(strategy) {}

  size_t batch() const override { return 4096; }

  void sampleAt(std::span<const LightPoint> points, std::span<const glm::uvec2> numbers,
                std::span<DirectionSample> out) const override {
    if (points.empty()) return;
    inPython([&] {
      std::vector<double> positions;
      std::vector<vec3> normals;
      for (const LightPoint& point : points) add(point, positions, normals);
      std::vector<double> u;
      for (const glm::uvec2& n : numbers) u.insert(u.end(), {n.x * 0x1p-32, n.y * 0x1p-32});
      const nb::tuple found = nb::cast<nb::tuple>(
          strategy_.attr("sample")(listOf(std::move(positions), 3),
                                   arrayOf<float>(std::move(normals)), listOf(std::move(u), 2)));
      const auto directions = arrayFrom(found[0]), pdfs = arrayFrom(found[1]);
      const auto* wi = reinterpret_cast<const vec3*>(directions.data());
      for (size_t i = 0; i < points.size(); ++i) {
        const float pdf = pdfs.data()[i];
        out[i] = {wi[i], pdf > 0 ? probe_.radiance(wi[i]) / pdf : Rgb(0), pdf};
      }
    });
  }

  void escapedMany(std::span<const Escape> rays, std::span<Escaped> out) const override {
    if (rays.empty()) return;
    inPython([&] {
      std::vector<double> positions;
      std::vector<vec3> normals, directions;
      for (const Escape& ray : rays) {
        add(*ray.point, positions, normals);
        directions.push_back(ray.wi);
      }
      const auto pdfs = arrayFrom(strategy_.attr("pdf")(arrayOf<float>(std::move(directions)),
                                                        listOf(std::move(positions), 3),
                                                        arrayOf<float>(std::move(normals))));
      for (size_t i = 0; i < rays.size(); ++i)
        out[i] = {probe_.radiance(rays[i].wi), pdfs.data()[i]};
    });
  }

  // Single vertices, where paths are not traced together.
  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override {
    const glm::uvec2 numbers(sampler.bits(dimension::kLight), sampler.bits(dimension::kLight + 1));
    DirectionSample found;
    sampleAt({&point, 1}, {&numbers, 1}, {&found, 1});
    if (found.pdf > 0) out.push_back(found);
  }
  Escaped escaped(const LightPoint& point, const vec3& wi) const override {
    const Escape ray{&point, wi};
    Escaped found;
    escapedMany({&ray, 1}, {&found, 1});
    return found;
  }

 private:
  void add(const LightPoint& point, std::vector<double>& positions,
           std::vector<vec3>& normals) const {
    const glm::dvec3 position = glm::dvec3(point.position) + origin_;
    positions.insert(positions.end(), {position.x, position.y, position.z});
    normals.push_back(point.normal);
  }
  // The strategy may use the renderer's functions, whose loops must not render meanwhile; nor may
  // another thread call it while those have released the interpreter.
  void inPython(const std::function<void()>& call) const {
    withoutOtherWork([&] {
      const std::lock_guard lock(calls_);
      const nb::gil_scoped_acquire acquired;
      if (!acquired.is_valid()) throw Interrupted("the interpreter ends");
      call();
    });
  }

  glm::dvec3 origin_;  // of the scene's coordinates in the world
  nb::handle strategy_;
  mutable std::mutex calls_;
};

}  // namespace

std::function<std::unique_ptr<LightSource>(const Probe&, const glm::dvec3&)> makerOf(
    nb::handle checked) {
  return [checked](const Probe& probe, const glm::dvec3& origin) {
    return std::make_unique<PythonLight>(probe, origin, checked);
  };
}

}  // namespace chromeball::python
