// SPDX-License-Identifier: Apache-2.0
#include "basis_vertices.h"

#include <algorithm>

#include "bake/baked_file.h"
#include "base/stopwatch.h"
#include "basis_job.h"
#include "job/memory_estimate.h"
#include "job/output_file.h"
#include "messages.h"
#include "progress_bar.h"
#include "relight/transfer_model.h"
#include "thread_limit.h"

namespace chromeball {
namespace {

// Options of the pixels of a light stage.
constexpr std::string_view kOfPixels[] = {
    "size",       "max-diffuse-depth", "max-specular-depth", "max-transmission-depth",
    "mis",        "glass-shadows",     "single-sided",       "transparent",
    "camera-file"};

void check(const SceneOptions& options, const std::string& output) {
  checkOutputFile(output, {".glb", ".gltf"});
  for (const Setting& setting : settingTable())
    if (options.settings.has(setting.name()) && std::ranges::count(kOfPixels, setting.option) > 0)
      throwInput("--{}: has no effect with --at vertices; leave it out", setting.option);
}

RenderJob transferJob(const SceneOptions& options) {
  RenderJob job = basisJob(options, "transfer");
  if (job.settings.maxDepth < 1)
    throwInput("--max-depth: should be 1 (direct light) or more for transfer");
  return job;
}

class BasisVertices {
 public:
  BasisVertices(const SceneOptions& options, const std::string& basis, const std::string& output)
      : options_(options),
        output_(output),
        basis_(basis, "--basis"),
        job_(transferJob(options)),
        loaded_(loadBasisScene(job_)) {
    checkDistinct({output}, loaded_.files);
  }

  void run() {
    const std::vector<PlacedMesh> meshes = placedMeshes(loaded_.scene);
    const std::vector<BakePoint> points = vertexPoints(meshes);
    if (points.empty())
      throwInput("{}: has no triangle with an area; there is no transfer", options_.scene);
    checkMemoryOf(points.size());
    const World world(loaded_.scene);
    print(loaded_.messages, options_.quiet());  // after the last error that input can cause
    ProgressBar bar(options_.showsProgress(), "transfer");
    const VertexTransfer transfer = estimateTransfer(
        world, meshes, points, basis_, settings(), [&](double fraction) { bar.update(fraction); });
    if (transfer.invalid.total() > 0)
      warn(fmt::format("{} invalid samples were left out; the first is of vertex {} {}",
                       transfer.invalid.total(), transfer.invalid.x, transfer.invalid.y));
    writeBaked(output_, loaded_.scene, transferGeometry(meshes, points, transfer), {},
               file(transfer));
    if (!options_.quiet())
      fmt::print("transfer of {} vertices in {:.2f} s, {}, {} samples: {}\n", points.size(),
                 watch_.seconds(), basis_.name(), job_.settings.samples, output_);
  }

 private:
  TransferSettings settings() const {
    return {job_.settings.samples, job_.settings.seed, job_.settings.maxDepth};
  }

  // The values, their columns, the bytes of the file's buffer and those of the file.
  void checkMemoryOf(size_t points) const {
    const double values = double(points) * double(basis_.size() + 1) * sizeof(Rgb);
    const double needed = 4 * values + estimateMemory(job_, loaded_).peak;
    if (needed > memoryLimit(job_))
      throw InputError(fmt::format("--basis {}: {} vertices with {} values take {:.3g} GB of "
                                   "memory with all else; the limit is {:.3g} GB",
                                   basis_.name(), points, basis_.size(), 1e-9 * needed,
                                   1e-9 * memoryLimit(job_)),
                       Remedy{"memory", {}});
    constexpr double kMostInFile = 4e9;
    if (values > kMostInFile)
      throwInput("--basis {}: {} vertices with {} values are more than a .glb can hold, 4 GiB",
                 basis_.name(), points, basis_.size());
  }

  BakedFile file(const VertexTransfer& transfer) const {
    BakedFile file{.look = BakedLook::Lit, .what = BakedLight::Irradiance};
    file.origin = loaded_.origin;
    file.camera = loaded_.camera;
    file.aspect = float(job_.settings.width) / float(job_.settings.height);
    const glm::dvec3& o = loaded_.origin;
    file.extras["chromeball"] = {{"basis", basis_.name()},
                                 {"samples", job_.settings.samples},
                                 {"maxDepth", job_.settings.maxDepth},
                                 {"seed", job_.settings.seed},
                                 {"origin", {o.x, o.y, o.z}},
                                 {"invalidSamples", transfer.invalid.total()}};
    return file;
  }

  const SceneOptions& options_;
  const std::string& output_;
  Stopwatch watch_;
  LightBasis basis_;
  RenderJob job_;
  LoadedScene loaded_;
};

}  // namespace

void runBasisVertices(const SceneOptions& options, const std::string& basis,
                      const std::string& output) {
  check(options, output);
  const ThreadLimit threads(options.settings);
  BasisVertices(options, basis, output).run();
}

}  // namespace chromeball
