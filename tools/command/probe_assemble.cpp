// SPDX-License-Identifier: Apache-2.0
// chromeball probe assemble PHOTO... -o OUT --azimuth 0,90
#include <fmt/format.h>

#include <algorithm>

#include "assemble_options.h"
#include "base/text.h"
#include "commands.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "json_values.h"
#include "messages.h"
#include "probe/capture/assemble.h"
#include "probe/capture/match_views.h"
#include "probe/convert.h"
#include "probe/mapping.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

struct Report {
  const AssembleArguments& arguments;
  const std::vector<AssemblyPhotograph>& photographs;
  const std::vector<CaptureView>& views;
  const std::vector<ViewMatch>& matches;
  const Assembly& assembly;
  const AssemblyTarget& target;
};

JsonValue toJson(const Report& report) {
  JsonValue views = JsonValue::array();
  for (size_t i = 0; i < report.views.size(); ++i) {
    const AssemblyPhotograph& p = report.photographs[i];
    const ViewMatch& match = report.matches[i];
    views.push_back(
        {{"file", p.file},
         {"circle", {p.circle.centre.x, p.circle.centre.y, p.circle.radius}},
         {"circle_support", p.found ? JsonValue(p.found->support) : JsonValue()},
         {"circle_standard_error", p.found ? JsonValue(p.found->standardError) : JsonValue()},
         {"azimuth", report.views[i].camera().azimuth},
         {"elevation", report.views[i].camera().elevation},
         {"overlap", match.overlap},
         {"correlation", match.correlation},
         {"turn", match.turn},
         {"turn_found", match.turned},
         {"gain", match.gain},
         {"gain_found", match.exposed}});
  }
  return {{"views", views},
          {"blind_share", report.assembly.blindShare},
          {"fill", report.arguments.fill},
          {"mapping", mappingName(report.target.mapping)},
          {"width", report.target.size.width},
          {"height", report.target.size.height}};
}

void print(const Report& report) {
  for (size_t i = 0; i < report.views.size(); ++i) {
    const AssemblyPhotograph& p = report.photographs[i];
    say("photograph   {}\n", printableName(p.file));
    say("circle       {:.2f},{:.2f},{:.2f}{}\n", p.circle.centre.x, p.circle.centre.y,
        p.circle.radius,
        p.found ? fmt::format(", found: +- {:.2f} pixels, {:.0f}% of it are edges",
                              p.found->standardError, 100 * p.found->support)
                : "");
    say("camera       azimuth {:.6g}, elevation {:.6g}\n", report.views[i].camera().azimuth,
        report.views[i].camera().elevation);
    if (i == 0) continue;
    const ViewMatch& match = report.matches[i];
    say("overlap      {:.3g}% of the sphere with the views before, correlation {:.3f}\n",
        100 * match.overlap, match.correlation);
    say("turned by    {:.3f} degrees\n", match.turn);
    say("multiplied   by {:.5g}\n", match.gain);
  }
  say("blind        {:.3g}% of the sphere, filled by {}\n", 100 * report.assembly.blindShare,
      report.arguments.fill);
  say("probe        {} x {}, {}\n", report.target.size.width, report.target.size.height,
      mappingName(report.target.mapping));
}

constexpr double kLargestDoubt = 0.1;  // of a circle, in pixels

// Luminance below the horizon / luminance above it.
double brightnessBelow(const Image& latLong) {
  double above = 0, below = 0;
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      (2 * y < latLong.height ? above : below) +=
          double(luminance(latLong.rgb(x, y))) * texelSolidAngle(y, latLong.width, latLong.height);
  return below / std::max(above, 1e-30);
}

// The sign of an elevation is easily mistaken: a lens looks away from where its camera is.
void warnOfUpsideDown(const Report& report) {
  constexpr double kSteep = 45, kBrightGround = 2;
  const auto& photographs = report.photographs;
  const bool isFisheye = report.arguments.isFisheye();
  const char* meaning =
      isFisheye ? "--azimuth A:E is where a lens looks from; one that looks up has 0:-90"
                : "--azimuth A:E is where the camera is, seen from the ball";
  const auto elevation = [](const AssemblyPhotograph& p) { return p.camera.elevation; };
  const auto looksDown = [](double e) { return e > kSteep; };
  const auto isSteep = [](double e) { return std::fabs(e) > kSteep; };
  if (isFisheye && std::ranges::all_of(photographs, looksDown, elevation)) {
    warn("{}: the lens looks below the horizon; {}", report.arguments.out, meaning);
  } else if (std::ranges::any_of(photographs, isSteep, elevation)) {
    const double ratio = brightnessBelow(report.assembly.latLong);
    if (ratio > kBrightGround)
      warn("{}: is {:.3g} times as bright below the horizon as above it; {}", report.arguments.out,
           ratio, meaning);
  }
}

void warnOf(const Report& report) {
  warnOfUpsideDown(report);
  for (size_t i = 0; i < report.views.size(); ++i) {
    const AssemblyPhotograph& p = report.photographs[i];
    const ViewMatch& match = report.matches[i];
    const double inside = shareInside(p.circle, p.image.width, p.image.height);
    if (inside < 0.999)
      warn("{}: {:.2g}% of its circle is outside the picture, and blind", p.file,
           100 * (1 - inside));
    if (p.found && p.found->standardError > kLargestDoubt)
      warn(
          "{}: the outline of the ball is doubtful, by {:.2g} pixels; see --preview, "
          "or give --circle X,Y,RADIUS",
          p.file, p.found->standardError);
    if (p.found && p.found->other)
      warn(
          "{}: {:.1f},{:.1f},{:.1f} may be the outline as well; see --preview, or give --circle "
          "X,Y,RADIUS",
          p.file, p.found->other->centre.x, p.found->other->centre.y, p.found->other->radius);
    if (i == 0) continue;
    if (!report.arguments.keepAzimuth && !match.turned)
      warn(
          "{}: no turn of up to {} degrees matches the photographs before (correlation "
          "{:.2f} over {:.0f}% of the sphere); its azimuth is kept",
          p.file, kLargestTurn, match.correlation, 100 * match.overlap);
    if (!report.arguments.keepExposure && !match.exposed)
      warn("{}: hardly overlaps the photographs before; its exposure is kept", p.file);
  }
  if (!report.arguments.isFisheye() && report.arguments.reflectivity.empty() &&
      report.arguments.ballIor.empty())
    warn(
        "no --reflectivity: the probe is as dark as the ball, which reflects only a part of the "
        "light");
  if (!report.arguments.isFisheye() && report.arguments.distance.empty())
    warn("no --distance: the camera is taken to be infinitely far from the ball");
}

Image preview(const Report& report) {
  std::vector<PhotographPreview> previews;
  for (size_t i = 0; i < report.views.size(); ++i) {
    const AssemblyPhotograph& p = report.photographs[i];
    previews.push_back({&p.image, &p.mask, p.circle, report.matches[i].gain});
  }
  return assemblyPreview(previews, report.assembly);
}

void run(const AssembleArguments& arguments, const Command& command) {
  checkFiles(arguments);
  const std::shared_ptr<const CaptureOptics> optics = parseOptics(arguments, command);
  const BlindFill fill = parseFill(arguments.fill);
  const std::vector<AssemblyPhotograph> photographs = loadPhotographs(arguments);
  std::vector<CaptureView> views;
  for (const AssemblyPhotograph& p : photographs)
    views.emplace_back(p.image, p.mask, p.circle, optics, p.camera);
  const AssemblyTarget target = parseTarget(arguments, views);
  std::optional<BusyLine> busy("assembling");
  const std::vector<ViewMatch> matches =
      matchViews(views, !arguments.keepExposure, !arguments.keepAzimuth);
  Assembly assembly = assemble(views, target.merged);
  fillBlind(fill, assembly);
  const Image probe = convert(assembly.latLong, Mapping::LatLong, target.mapping, target.size);
  busy.reset();

  const Report report{arguments, photographs, views, matches, assembly, target};
  warnOf(report);
  writeProbe(arguments.out, probe, target.mapping);
  if (!arguments.preview.empty()) print(writeImage(arguments.preview, preview(report)));
  arguments.json ? printJson(toJson(report)) : print(report);
}

}  // namespace

void addProbeAssembleCommand(Command probe) {
  auto [command, a] = probe.addCommand<AssembleArguments>(
      "assemble", "Make a probe from photographs of a mirror ball, or through a fisheye lens.",
      run);
  addAssembleOptions(command, a);
}

}  // namespace chromeball
