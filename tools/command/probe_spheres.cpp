// SPDX-License-Identifier: Apache-2.0
// chromeball probe spheres PREDICTED TRUE
#include <algorithm>
#include <optional>

#include "approximate/probe_spheres.h"
#include "base/error.h"
#include "commands.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image/tonemap.h"
#include "image_files.h"
#include "json_values.h"
#include "measure/false_color.h"
#include "measure/image_error.h"
#include "messages.h"
#include "probe/load.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

struct ProbeSpheresArguments {
  std::string predicted, truth, out, predictedMapping = "auto", trueMapping = "auto";
  int diameter = 96;
  bool json = false;
};

using Spheres = std::array<SphereImages, 3>;  // each under the predicted and the true probe

Image maskOf(int diameter) {
  Image mask(diameter, diameter, 1);
  for (int y = 0; y < diameter; ++y)
    for (int x = 0; x < diameter; ++x) *mask.at(x, y) = isOnSphere(x, y, diameter) ? 1 : 0;
  return mask;
}

// The exposure that makes the brightest channel of the true diffuse sphere white.
float exposureOf(const Spheres& spheres) {
  const float brightest = std::ranges::max(spheres[0][1].texels);
  return brightest > 0 ? 1 / brightest : 1;
}

// From blue, too dark, over white, equal, to red, too bright.
Rgb differenceColor(const Rgb& difference) {
  const Color8 color = signedColor(std::clamp(luminance(difference), -1.0f, 1.0f));
  Rgb linear;
  for (int c = 0; c < 3; ++c) linear[c] = srgbToLinear(float(color[size_t(c)]) / 255);
  return linear;
}

// Three rows: predicted, true, and their difference, in one exposure.
Image pictureOf(const Spheres& spheres, const Image& mask) {
  const int diameter = mask.width, gap = std::max(2, diameter / 16), step = diameter + gap;
  constexpr float kBackground = 0.015f;
  const float exposure = exposureOf(spheres);
  Image picture(3 * step + gap, 3 * step + gap, 3);
  std::ranges::fill(picture.texels, kBackground);
  for (int column = 0; column < 3; ++column)
    for (int y = 0; y < diameter; ++y)
      for (int x = 0; x < diameter; ++x) {
        if (*mask.at(x, y) == 0) continue;
        const Rgb p = exposure * spheres[size_t(column)][0].rgb(x, y);
        const Rgb t = exposure * spheres[size_t(column)][1].rgb(x, y);
        const Rgb rows[] = {p, t, differenceColor(p - t)};
        for (int row = 0; row < 3; ++row)
          picture.setRgb(gap + column * step + x, gap + row * step + y, rows[row]);
      }
  return picture;
}

void print(const std::array<EstimateError, 3>& errors) {
  say("{:<14} {:>10} {:>10} {:>10} {:>16}\n", "sphere", "RMSE", "si-RMSE", "scale",
      "angular error");
  for (size_t i = 0; i < errors.size(); ++i) {
    const EstimateError& e = errors[i];
    say("{:<14} {:>10.4g} {:>10.4g} {:>10.4g} {:>8.4g} degrees\n", kSphereNames[i], e.rmse,
        e.scaleInvariantRmse, e.scale, e.angularError);
  }
}

JsonValue toJson(const ProbeSpheresArguments& arguments,
                 const std::array<EstimateError, 3>& errors) {
  JsonValue json = {{"predicted", arguments.predicted}, {"true", arguments.truth}};
  json["diameter"] = arguments.diameter;
  json["spheres"] = JsonValue::array();
  for (size_t i = 0; i < errors.size(); ++i) {
    const EstimateError& e = errors[i];
    json["spheres"].push_back({{"name", kSphereNames[i]},
                               {"rmse", e.rmse},
                               {"si_rmse", e.scaleInvariantRmse},
                               {"scale", e.scale},
                               {"angular_error", orNull(e.angularError)}});
  }
  return json;
}

void run(const ProbeSpheresArguments& arguments) {
  if (!arguments.out.empty()) {
    checkWritable(arguments.out);
    checkDistinct({arguments.out}, {arguments.predicted, arguments.truth});
  }
  const Image probes[] = {
      openProbe(arguments.predicted, arguments.predictedMapping, "--probe-mapping-predicted")
          .latLong,
      openProbe(arguments.truth, arguments.trueMapping, "--probe-mapping-true").latLong};
  std::optional<BusyLine> busy("rendering the spheres");
  const Spheres spheres = probeSpheres(probes, arguments.diameter);
  busy.reset();
  const Image mask = maskOf(arguments.diameter);
  std::array<EstimateError, 3> errors;
  for (size_t i = 0; i < errors.size(); ++i)
    errors[i] = estimateError(spheres[i][0], spheres[i][1], mask);
  arguments.json ? printJson(toJson(arguments, errors)) : print(errors);
  if (!arguments.out.empty()) print(writeImage(arguments.out, pictureOf(spheres, mask)));
}

}  // namespace

void addProbeSpheresCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeSpheresArguments>(
      "spheres", "Compare estimated light with the true light on three spheres.", run);
  command.addRequired("PREDICTED", a.predicted, "the probe that was estimated");
  command.addRequired("TRUE", a.truth, "the probe that was captured");
  command.addFlag("--json", a.json, "print JSON");
  command.addOption("-o,--output", a.out,
                    "write a picture: the spheres under PREDICTED, under TRUE, and the difference "
                    "(blue: PREDICTED is too dark; red: too bright)");
  command.addWithDefault("--size", a.diameter, "diameter of a sphere in pixels").inRange(8, 1024);
  command.addOption("--probe-mapping-predicted,--mapping-predicted", a.predictedMapping,
                    "the mapping of PREDICTED; auto detects it");
  command.addOption("--probe-mapping-true,--mapping-true", a.trueMapping,
                    "the mapping of TRUE; auto detects it");
  command.footer(
      "The spheres: grey diffuse, matte silver and mirror, each alone. RMSE is in the probes' "
      "units; si-RMSE is that after the best factor, `scale`, on PREDICTED; the angular error is "
      "the mean angle between colours.\n");
}

}  // namespace chromeball
