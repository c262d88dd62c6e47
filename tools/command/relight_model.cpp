// SPDX-License-Identifier: Apache-2.0
#include "relight_model.h"

#include "bake/baked_file.h"
#include "bake/shown_color.h"
#include "bake/vertex_light.h"
#include "base/error.h"
#include "base/stopwatch.h"
#include "job/arguments.h"
#include "job/output_file.h"
#include "messages.h"
#include "probe/load.h"
#include "probe/probe.h"
#include "relight/escaping_path.h"
#include "relight/transfer_model.h"

namespace chromeball {
namespace {

// Of `count` coefficients.
size_t parseKeep(std::string text, size_t count) {
  const bool isPercent = text.back() == '%';
  if (isPercent) text.pop_back();
  const double number = parseNumbers(text, 1, "--keep")[0];
  const double kept = isPercent ? std::round(number / 100 * double(count)) : number;
  if (!(number > 0) || number > (isPercent ? 100 : double(count)) || kept != std::floor(kept))
    throwInput(
        "--keep: should be a whole number from 1 to {}, or a percentage above 0 and up to "
        "100%",
        count);
  return std::max<size_t>(size_t(kept), 1);
}

class RelightModel {
 public:
  explicit RelightModel(const RelightModelOptions& options)
      : options_(options),
        model_(options.model, options.allowsExternal ? ExternalFiles::Allow : ExternalFiles::Refuse,
               [&](const std::string& line) { warnings_.push_back(line); }),
        kept_(parseKeep(options.keep, model_.basis().size())),
        world_(model_.scene()),
        tracer_(world_, dark_, {}) {}

  void run() {
    checkDistinct({options_.output}, model_.scene().files);
    std::vector<Rgb> light = coefficients();
    const Stopwatch watch;
    keepMostImportant(model_.basis(), kept_, light);
    const std::vector<PlacedMesh> meshes = placedMeshes(model_.scene());
    const std::vector<BakePoint> points = vertexPoints(meshes);
    const TransferModel::Lit lit = model_.lit(points, light);
    const double seconds = watch.seconds();
    const PointLight what(tracer_, BakedLight::Irradiance, INFINITY);
    std::vector<BakedGeometry> geometry = colouredGeometry(what, meshes, points, lit.light);
    const float white =
        options_.white ? float(*options_.white) : scaleOf(brightestOf(what, geometry));
    writeBaked(options_.output, model_.scene(), geometry, {}, file(white));
    if (lit.negative > 0)
      warnings_.push_back(fmt::format(
          "{} of {} vertices had a negative channel, which was raised to 0: {} light rings there",
          lit.negative, points.size(), model_.basis().name()));
    if (options_.quiet) return;
    for (const std::string& line : warnings_) warn(line);
    fmt::print("lit {} vertices in {:.3f} s by {} of {} coefficients of {}, scale {:g}: {}\n",
               points.size(), seconds, kept_, model_.basis().size(), model_.basis().name(), white,
               options_.output);
  }

 private:
  std::vector<Rgb> coefficients() {
    const LoadedProbe loaded = loadProbe(options_.probe, options_.mapping, "--mapping");
    for (const auto& lines :
         {warnings(loaded, options_.probe), lightWarnings(loaded, options_.probe)})
      warnings_.insert(warnings_.end(), lines.begin(), lines.end());
    const Rgb scale = parseColor(options_.scale, "--scale");
    const Image map = Probe(loaded.latLong, {}, scale).latLong();
    return model_.basis().project(map, options_.rotation);
  }

  BakedFile file(float white) const {
    BakedFile file{.look = BakedLook::Unlit, .what = BakedLight::Irradiance};
    file.scale = white;
    file.origin = model_.origin();
    if (!model_.scene().cameras.empty()) file.camera = model_.scene().cameras.front();
    file.extras["chromeball"] = {
        {"relit", std::filesystem::path(options_.model).filename().string()},
        {"probe", std::filesystem::path(options_.probe).filename().string()},
        {"basis", model_.basis().name()},
        {"kept", kept_},
        {"scale", white}};
    return file;
  }

  const RelightModelOptions& options_;
  std::vector<std::string> warnings_;
  TransferModel model_;
  size_t kept_;
  World world_;
  NoProbe dark_;
  PathTracer tracer_;
};

}  // namespace

void runRelightModel(const RelightModelOptions& options) {
  checkOutputFile(options.output, {".glb", ".gltf"});
  checkDistinct({options.output}, {options.model, options.probe});
  if (options.white && !isPositiveFloat(*options.white))
    throwInput("--white: should be {}", kPositiveFloats);
  RelightModel(options).run();
}

}  // namespace chromeball
