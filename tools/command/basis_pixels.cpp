// SPDX-License-Identifier: Apache-2.0
#include "basis.h"

#include <algorithm>
#include <optional>

#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "film/rows.h"
#include "image/io/output_file.h"
#include "interrupt.h"
#include "messages.h"
#include "progress_bar.h"
#include "relight/stage/render_basis.h"
#include "relight/stage/stage_file.h"
#include "session/memory_estimate.h"

namespace chromeball {
namespace {

int ceilDivide(int a, int b) { return (a + b - 1) / b; }

// The rows of a band: all rows if they fit into the memory; else whole tiles, in bands of about
// equal height.
int rowsOfBand(const LoadedScene& loaded, const DirectionBasis& basis) {
  const RenderDescription& description = loaded.description;
  constexpr int kTile = TileGrid::kSize;
  const RenderSettings& s = description.settings;
  checkStageSize(basis, s.width, s.height, "--directions");
  const MemoryEstimate estimate = estimateMemory(loaded);
  const double limit = memoryLimit(description);
  const double row = elementBytes(basis) * s.width + estimate.images / s.height;
  const double rest = estimate.peak - estimate.images + StageWriter::bufferBytes(basis, s.width);
  const double most = (limit - rest) / row;
  if (most >= s.height) return s.height;
  const int least = std::min(kTile, s.height);
  if (most < least)
    throw InputError(
        fmt::format("--directions: {} elements of {} rows of {} pixels, the least at a time, take "
                    "{:.3g} GB of memory, with all else {:.3g} GB; the limit is {:.3g} GB",
                    basis.size(), least, s.width, 1e-9 * row * least, 1e-9 * (rest + row * least),
                    1e-9 * limit),
        Remedy{"memory", {}});
  const int bands = ceilDivide(s.height, int(most) / kTile * kTile);
  return ceilDivide(ceilDivide(s.height, bands), kTile) * kTile;
}

Metadata metadataOf(const SceneOptions& options, const RenderDescription& description) {
  return {{"Software", std::string("chromeball " CHROMEBALL_VERSION)},
          {"scene", options.scene},
          {"samples", int(description.settings.samples)},
          {"seed", std::to_string(description.settings.seed)},
          {"max_depth", description.settings.maxDepth}};
}

struct Written {
  InvalidSamples invalid;
  bool hasOwnLight = false;
  uint64_t clipped = 0;  // numbers beyond the range of halves
};

// Renders and writes bands of `rows` rows.
Written writeStage(const BasisRenderer& renderer, const RenderSettings& s, int rows,
                   const BasisArguments& own, const Metadata& metadata, const Progress& progress) {
  std::optional<StageWriter> file;
  Written written;
  for (int top = 0; top < s.height; top += rows) {
    const int count = std::min(rows, s.height - top);
    const BasisRender band = renderer.render(
        top, count, [&](double done) { progress((top + done * count) / s.height); }, interrupted);
    if (interrupted) throw Interrupted(fmt::format("interrupted; {} is not written", own.out));
    if (!file) file.emplace(own.out, band.stage, s.height, metadata, own.halves);
    file->write(band.stage, band.color);
    written.invalid.add(band.invalid);
    written.hasOwnLight = !band.stage.own.empty();
  }
  file->commit();
  written.clipped = file->clipped();
  return written;
}

}  // namespace

void runBasisPixels(const BasisArguments& a) {
  const Stopwatch watch;
  const DirectionBasis basis(a.directions.empty() ? "lat-long:32x16" : a.directions,
                             "--directions");
  checkOutputFile(a.out, {".exr"});
  const ThreadLimit threads = threadLimit(a.settings);
  RenderDescription description = basisJob(a, SceneCommand::Basis);
  const LoadedScene loaded = loadBasisScene(description);
  description = loaded.description;
  checkDistinct({a.out}, loaded.files);
  const int rows = rowsOfBand(loaded, basis);
  const RenderSettings& s = description.settings;
  const World world(loaded.scene, {}, BsdfTables(loaded.scene.materials, false));
  print(loaded.messages);  // after the last error that input can cause
  const BasisRenderer renderer(world, loaded.camera, basis, s);
  catchInterrupts();
  const Written written = [&] {
    ProgressBar bar(progressStyle());
    return writeStage(renderer, s, rows, a, metadataOf(a, description),
                      [&](double done) { bar.update(done); });
  }();
  if (const InvalidSamples& invalid = written.invalid; invalid.total() > 0)
    warn("{} invalid samples were left out; the first is in pixel {}, {}", invalid.total(),
         invalid.x, invalid.y);
  if (written.clipped > 0)
    warn("{}: {} numbers above 65504, the largest of 16 bits, were clipped; leave out --half",
         a.out, written.clipped);
  say("{} x {} pixels, {} samples, {} elements ({}){}{} in {:.2f} s: {}\n", s.width, s.height,
      s.samples, basis.size(), basis.name(),
      written.hasOwnLight ? " and the scene's own light" : "",
      rows < s.height ? fmt::format(", in {} bands", ceilDivide(s.height, rows)) : "",
      watch.seconds(), printableName(a.out));
}

}  // namespace chromeball
