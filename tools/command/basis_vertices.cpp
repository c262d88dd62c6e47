// SPDX-License-Identifier: Apache-2.0
#include "basis_vertices.h"

#include "bake/baked_file.h"
#include "base/stopwatch.h"
#include "job/job.h"
#include "job/memory_estimate.h"
#include "job/output_file.h"
#include "messages.h"
#include "progress_bar.h"
#include "relight/transfer_model.h"
#include "thread_limit.h"

namespace chromeball {
namespace {

// Transfer needs no light of the user's: a lamp stands for it until the scene is loaded.
RenderJob plannedJob(const BasisVerticesOptions& a, bool& hasStandIn) {
  SceneFile scene = openScene(a.scene);
  if (scene.composite)
    throwInput("{}: a composite has no transfer; take its model", scene.composite->location);
  hasStandIn = !scene.settings.has("probe.file");
  if (hasStandIn) scene.lamps.push_back({.ambient = AmbientLamp{}});
  return planJob(std::move(scene), a.settings);
}

class BasisVertices {
 public:
  explicit BasisVertices(const BasisVerticesOptions& options)
      : options_(options),
        basis_(LightBasis::parse(options.basis, "--basis")),
        job_(plannedJob(options, hasStandIn_)),
        loaded_(loadScene(job_)) {
    if (hasStandIn_) loaded_.scene.ambient.pop_back();
    checkDistinct({options.output}, loaded_.files);
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
    writeBaked(options_.output, loaded_.scene, transferGeometry(meshes, points, transfer), {},
               file(transfer));
    if (!options_.quiet())
      fmt::print("transfer of {} vertices in {:.2f} s, {}, {} samples: {}\n", points.size(),
                 watch_.seconds(), basis_.name(), job_.settings.samples, options_.output);
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

  const BasisVerticesOptions& options_;
  Stopwatch watch_;
  LightBasis basis_;
  bool hasStandIn_ = false;
  RenderJob job_;
  LoadedScene loaded_;
};

}  // namespace

void runBasisVertices(const BasisVerticesOptions& options) {
  checkOutputFile(options.output, {".glb", ".gltf"});
  if (options.settings.get<int64_t>("render.max_depth") < 1)
    throwInput("--max-depth: should be 1 (direct light) or more for transfer");
  const ThreadLimit threads(options.settings);
  BasisVertices(options).run();
}

}  // namespace chromeball
