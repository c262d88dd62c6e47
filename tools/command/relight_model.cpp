// SPDX-License-Identifier: Apache-2.0
#include "relight.h"

#include "bake/baked_file.h"
#include "bake/vertex_light.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image_files.h"
#include "messages.h"
#include "probe/probe.h"
#include "relight/transfer/glossy_model.h"
#include "relight/transfer/transfer_points.h"

namespace chromeball {
namespace {

// The number of coefficients to keep, out of `count`.
size_t parseKeep(std::string text, size_t count) {
  const bool isPercent = text.back() == '%';
  if (isPercent) text.pop_back();
  const double number = parseNumbers(text, 1, "--keep")[0];
  const double kept = isPercent ? std::round(number / 100 * double(count)) : number;
  if (!(number > 0) || number > (isPercent ? 100 : double(count)) || kept != std::floor(kept))
    throwInput(
        "--keep: should be a whole number from 1 to {}, or a percentage above 0 and up to 100%",
        count);
  return std::max<size_t>(size_t(kept), 1);
}

class RelightModel {
 public:
  explicit RelightModel(const RelightOptions& options)
      : options_(options),
        file_(options.stage, options.allowsExternal ? ExternalFiles::Allow : ExternalFiles::Refuse,
              [&](const std::string& line) { warnings_.push_back(line); }),
        what_(isGlossy(file_) ? BakedLight::Radiance : BakedLight::Irradiance),
        kept_(parseKeep(options.keep, file_.basis().size())),
        world_(file_.scene()),
        tracer_(world_, dark_, {}) {
    if (isGlossy(file_) == options.view.empty())
      throwInput("{}: {}", options.view.empty() ? options.stage : "--view",
                 options.view.empty() ? "its transfer is glossy; give the eye by --view X,Y,Z"
                                      : "the model's transfer is diffuse, the same from each side");
  }

  void run() {
    checkDistinct({options_.out}, file_.scene().files);
    std::vector<Rgb> light = coefficients();
    const Stopwatch watch;
    keepMostImportant(file_.basis(), kept_, light);
    const std::vector<PlacedMesh> meshes = placedMeshes(file_.scene());
    const std::vector<BakePoint> points = vertexPoints(meshes);
    const TransferLight lit = lightAt(meshes, points, light);
    const double seconds = watch.seconds();
    const PointLight what(tracer_, what_, INFINITY);
    std::vector<BakedGeometry> geometry = colouredGeometry(what, meshes, points, lit.light);
    const float white =
        options_.white ? float(*options_.white) : scaleOf(brightestOf(what, geometry));
    writeBaked(options_.out, file_.scene(), geometry, {}, file(white));
    if (lit.negative > 0)
      warnings_.push_back(fmt::format(
          "{} of {} vertices had a negative channel, which was raised to 0: {} light rings there",
          lit.negative, points.size(), file_.basis().name()));
    for (const std::string& line : warnings_) warn(line);
    say("lit {} vertices in {:.3f} s by {} of {} coefficients of {}, scale {:g}: {}\n",
        points.size(), seconds, kept_, file_.basis().size(), file_.basis().name(), white,
        printableName(options_.out));
  }

 private:
  TransferLight lightAt(const std::vector<PlacedMesh>& meshes, const std::vector<BakePoint>& points,
                        std::span<const Rgb> light) const {
    TransferLight lit;
    if (options_.view.empty()) {
      lit = lightOf(file_, points, light);
    } else {
      const std::vector<double> eye = parseNumbers(options_.view, 3, "--view");
      lit = lightTowards(file_, meshes, points, light,
                         glm::dvec3(eye[0], eye[1], eye[2]) - file_.data().origin);
    }
    for (const PointResult& point : lit.light.points)
      if (!isFinite(point.mean()))
        throwInput("{}: the light exceeds the largest float, 3.4e38; give a smaller --probe-scale",
                   options_.stage);
    return lit;
  }

  std::vector<Rgb> coefficients() {
    const LoadedProbe loaded =
        openProbe(options_.probes.front(), options_.mapping, "--probe-mapping");
    const Rgb scale = parseColor(options_.scale, "--probe-scale");
    const Image map = Probe(loaded.latLong, {}, scale).latLong();
    return file_.basis().project(map, options_.rotation);
  }

  BakedFile file(float white) const {
    BakedFile file{.look = BakedLook::Unlit, .what = what_};
    file.scale = white;
    file.origin = file_.data().origin;
    if (!file_.scene().cameras.empty()) file.camera = file_.scene().cameras.front();
    file.extras["chromeball"] = {
        {"relit", std::filesystem::path(options_.stage).filename().string()},
        {"probe", std::filesystem::path(options_.probes.front()).filename().string()},
        {"basis", file_.basis().name()},
        {"kept", kept_},
        {"scale", white}};
    if (!options_.view.empty()) file.extras["chromeball"]["view"] = options_.view;
    return file;
  }

  const RelightOptions& options_;
  std::vector<std::string> warnings_;
  TransferFile file_;
  BakedLight what_;
  size_t kept_;
  World world_;
  NoProbe dark_;
  PathTracer tracer_;
};

}  // namespace

void runRelightModel(const RelightOptions& options) {
  checkOutputFile(options.out, {".glb", ".gltf"});
  checkDistinct({options.out}, {options.stage, options.probes.front()});
  if (options.white && !isPositiveFloat(*options.white))
    throwInput("--white: should be {}", kPositiveFloats);
  RelightModel(options).run();
}

}  // namespace chromeball
