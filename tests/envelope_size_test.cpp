// SPDX-License-Identifier: Apache-2.0
// tests/ENVELOPE.md: the rows about the number of triangles and of samples per pixel.
#include <gtest/gtest.h>

#include <cstdlib>

#include "base/json.h"
#include "envelope.h"
#include "gltf_writer.h"
#include "image/io/write_image.h"
#include "instrumented.h"
#include "json_file.h"
#include "probe/synth.h"
#include "run_command.h"

namespace chromeball::envelope_size_test {
namespace {

// Path of a model file of a wavy sheet with at least `triangles` triangles.
std::string sheet(GltfWriter& w, double triangles) {
  const uint32_t side = uint32_t(std::ceil(std::sqrt(triangles / 2))) + 1;  // vertices
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  positions.reserve(size_t(side) * side * 3), indices.reserve(size_t(side) * side * 6);
  for (uint32_t y = 0; y < side; ++y)
    for (uint32_t x = 0; x < side; ++x) {
      const float u = float(x) / float(side - 1), v = float(y) / float(side - 1);
      positions.insert(positions.end(), {u, 0.1f * std::sin(20 * u) * std::cos(20 * v), v});
      if (x + 1 == side || y + 1 == side) continue;
      const uint32_t i = y * side + x;
      indices.insert(indices.end(), {i, i + side, i + 1, i + 1, i + side, i + side + 1});
    }
  w.add("nodes",
        {{"mesh",
          w.mesh({{"attributes", {{"POSITION", w.vec3s(positions)}}},
                  {"indices", w.accessor(w.view(indices), kUInt, "SCALAR", indices.size())}})}});
  return w.save();
}

// CHROMEBALL_TRIANGLES overrides the number of triangles.
TEST(SlowEnvelopeSize, MemoryAndTimeOfATriangle) {
  if (kIsInstrumented) GTEST_SKIP() << kMeasuresMemory;
  const char* variable = std::getenv("CHROMEBALL_TRIANGLES");
  const double triangles = variable ? std::atof(variable) : 5e5;
  const TemporaryFolder out;
  writeImage(out / "probe.exr", constantProbe({8, 4}, Rgb(1)));
  const auto renderSheet = [&](double count) {
    GltfWriter writer;
    const CommandResult result =
        runCommand({"render", sheet(writer, count), "--probe", out / "probe.exr", "--size", "64x64",
                    "--samples", "4", "--quiet", "--stats", out / "s.json", "-o", out / "a.exr"});
    EXPECT_EQ(result.status, 0) << result.error;
    return jsonOfFile(out / "s.json");
  };
  const auto few = renderSheet(2), many = renderSheet(triangles);
  const double bytes =
      (many["peak_memory_bytes"].get<double>() - few["peak_memory_bytes"].get<double>()) /
      triangles;
  std::printf("%.3g triangles: %.0f bytes each; load %.2f us, build %.2f us each\n", triangles,
              bytes, 1e6 * many["seconds"]["load"].get<double>() / triangles,
              1e6 * many["seconds"]["build"].get<double>() / triangles);
  EXPECT_GT(bytes, 20);
  EXPECT_LT(bytes, 400);
}

// The squared error of a render falls as 1/N or faster, up to a million samples per pixel.
TEST(SlowEnvelopeSize, TheErrorOfAMillionSamples) {
  const Probe probe(constantProbe({8, 4}, Rgb(1)));
  const auto squaredError = [&](int samples) {
    const RenderResult r = renderScene(plane(lambert(Rgb(0.5f))), topCamera(3, 40), probe,
                                       "uniform", smallRender(2, 2, samples, 1));
    double sum = 0;
    const Image mean = r.film.mean();
    for (float x : mean.texels) sum += std::pow(double(x) - 0.5, 2);
    return sum / double(mean.texels.size());
  };
  double before = squaredError(100);
  for (int samples : {10'000, 1'000'000}) {
    const double after = squaredError(samples);
    std::printf("%d samples: squared error %.2g\n", samples, after);
    EXPECT_LT(after, before / 100) << samples;
    before = after;
  }
}

}  // namespace
}  // namespace chromeball::envelope_size_test
