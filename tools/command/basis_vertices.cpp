// SPDX-License-Identifier: Apache-2.0
#include "basis.h"

#include <algorithm>

#include "bake/baked_file.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/io/output_file.h"
#include "messages.h"
#include "progress_bar.h"
#include "relight/transfer/glossy_model.h"
#include "session/memory_estimate.h"

namespace chromeball {
namespace {

void check(const BasisArguments& options) {
  checkOutputFile(options.out, {".glb", ".gltf"});
  for (const Setting& setting : settingTable())
    if (options.settings.has(setting.name()) && !isOptionOf(SceneCommand::BasisVertices, setting))
      throwInput("--{}: has no effect with --at vertices; leave it out", setting.option);
}

RenderDescription transferJob(const SceneOptions& options) {
  RenderDescription description = basisJob(options, SceneCommand::BasisVertices);
  if (description.settings.maxDepth < 1)
    throwInput("--max-depth: should be 1 (direct light) or more for transfer");
  description.run.makesImage = false;
  return description;
}

class BasisVertices {
 public:
  explicit BasisVertices(const BasisArguments& options)
      : options_(options),
        basis_(options.functions.empty() ? "sh:4" : options.functions, "--basis"),
        loaded_(loadBasisScene(transferJob(options))) {
    checkDistinct({options.out}, loaded_.files);
  }

  void run() {
    const std::vector<PlacedMesh> meshes = placedWithinMemory(loaded_);
    const std::vector<BakePoint> points = vertexPoints(meshes);
    if (points.empty())
      throwInput("{}: has no triangle with an area; there is no transfer", options_.scene);
    options_.isGlossy ? checkGlossyMemory(points.size()) : checkMemory(points.size());
    const World world(loaded_.scene, {}, BsdfTables(loaded_.scene.materials, false));
    print(loaded_.messages);  // after the last error that input can cause
    options_.isGlossy ? writeGlossy(world, meshes, points) : writeDiffuse(world, meshes, points);
    say("transfer of {} vertices in {:.2f} s, {}, {} samples{}: {}\n", points.size(),
        watch_.seconds(), basis_.name(), loaded_.description.settings.samples, summary_,
        printableName(options_.out));
  }

 private:
  void writeDiffuse(const World& world, const std::vector<PlacedMesh>& meshes,
                    const std::vector<BakePoint>& points) const {
    ProgressBar bar(progressStyle(), "transfer");
    const VertexTransfer transfer = estimateTransfer(
        world, meshes, points, basis_, settings(), [&](double fraction) { bar.update(fraction); });
    report(transfer.invalid);
    writeBaked(options_.out, loaded_.scene, transferGeometry(meshes, points, transfer), {},
               file(transfer.invalid));
  }

  void writeGlossy(const World& world, const std::vector<PlacedMesh>& meshes,
                   const std::vector<BakePoint>& points) {
    ProgressBar bar(progressStyle(), "transfer");
    const GlossyTransfer transfer = estimateGlossyTransfer(
        world, meshes, points, basis_, settings(), [&](double fraction) { bar.update(fraction); });
    report(transfer.matrices.invalid);
    const Signals signals = signalsOf(transfer);
    if (signals.count() == 0)
      throwInput("{}: all vertices are inside of bodies; there is no transfer", options_.scene);
    const int vectors = int(options_.vectors.value_or(8));
    const ClusteredPca pca = clusteredPca(signals, int(options_.clusters.value_or(16)), vectors);
    GlossyFile glossy = glossyFile(meshes, points, transfer, pca);
    BakedFile out = file(transfer.matrices.invalid);
    out.extras["chromeball"]["compressionError"] = pca.error;
    out.tables = std::move(glossy.tables);
    writeBaked(options_.out, loaded_.scene, glossy.geometry, {}, out);
    summary_ = fmt::format(", {} clusters of {} vectors, error {:.3g}%", pca.clusters.size(),
                           vectors, 100 * pca.error);
  }

  static void report(const InvalidSamples& invalid) {
    if (invalid.total() > 0)
      warn("{} invalid samples were left out; the first is of vertex {} {}", invalid.total(),
           invalid.x, invalid.y);
  }

  TransferSettings settings() const {
    return {loaded_.description.settings.samples, loaded_.description.settings.seed,
            loaded_.description.settings.maxDepth};
  }

  // Counts the values, their columns, the file's buffer and the file's bytes.
  void checkMemory(size_t points) const {
    const double values = double(points) * double(basis_.size() + 1) * sizeof(Rgb);
    checkMemoryWithScene(loaded_, 4 * values,
                         fmt::format("--basis {}: {} vertices with {} values take", basis_.name(),
                                     points, basis_.size()));
    constexpr double kMostInFile = 4e9;
    if (values > kMostInFile)
      throwInput("--basis {}: {} vertices with {} values are more than a .glb can hold, 4 GiB",
                 basis_.name(), points, basis_.size());
  }

  // Counts the values, the signals, a cluster's signals in double precision, and the products of
  // its analysis.
  void checkGlossyMemory(size_t points) const {
    const double count = ViewGrid::kCount * double(basis_.size() + 1);
    const double product = std::min(double(points), 3 * count);
    checkMemoryWithScene(
        loaded_, 5 * double(points) * count * sizeof(Rgb) + 3 * sizeof(double) * product * product,
        fmt::format("--glossy: {} vertices with matrices of {} x {} take", points, ViewGrid::kCount,
                    basis_.size() + 1));
  }

  BakedFile file(const InvalidSamples& invalid) const {
    BakedFile file{.look = BakedLook::Lit, .what = BakedLight::Irradiance};
    file.origin = loaded_.origin;
    file.camera = loaded_.camera;
    file.aspect =
        float(loaded_.description.settings.width) / float(loaded_.description.settings.height);
    const glm::dvec3& o = loaded_.origin;
    file.extras["chromeball"] = {{"basis", basis_.name()},
                                 {"samples", loaded_.description.settings.samples},
                                 {"maxDepth", loaded_.description.settings.maxDepth},
                                 {"seed", loaded_.description.settings.seed},
                                 {"origin", {o.x, o.y, o.z}},
                                 {"invalidSamples", invalid.total()}};
    return file;
  }

  const BasisArguments& options_;
  Stopwatch watch_;
  LightBasis basis_;
  LoadedScene loaded_;
  std::string summary_;  // of the compression
};

}  // namespace

void runBasisVertices(const BasisArguments& a) {
  check(a);
  const ThreadLimit threads = threadLimit(a.settings);
  BasisVertices(a).run();
}

}  // namespace chromeball
