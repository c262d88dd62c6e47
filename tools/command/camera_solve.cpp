// SPDX-License-Identifier: Apache-2.0
// chromeball camera solve MODEL PLATE --points P.csv | --lines L.csv | --fspy F.json -o camera.toml
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "base/error.h"
#include "commands.h"
#include "composite/plate.h"
#include "front/arguments.h"
#include "front/scene_file.h"
#include "front/scene_file_sections.h"
#include "image/io/exif.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "json_values.h"
#include "messages.h"
#include "scene/camera.h"
#include "scene/gltf/load_gltf.h"
#include "scene/solve/observations.h"
#include "scene/solve/solve_camera.h"

namespace chromeball {
namespace {

struct CameraSolveArguments {
  std::string model, plate, points, lines, fspy, output, preview;
  std::string principalPoint, origin, up = "y";
  std::optional<double> fov, focal35, height;
  bool distortion = false, json = false;
};

void check(const CameraSolveArguments& a, const Command& command) {
  if (a.points.empty() + a.lines.empty() + a.fspy.empty() != 2)
    throwInput("give one of --points, --lines and --fspy");
  if (a.points.empty()) command.refuse({"--distortion"}, "is for --points");
  if (a.lines.empty()) command.refuse({"--height", "--origin"}, "is for --lines");
  if (a.fspy.empty() && a.up != "y") throwInput("--up: is for --fspy");
  if (!a.fspy.empty())
    command.refuse({"--fov", "--focal35", "--principal-point"}, "is for --points and --lines");
  if (a.fov && a.focal35) throwInput("--fov: excludes --focal35; give one");
  if (a.fov && !(*a.fov >= 0.01 && *a.fov < 179))
    throwInput("--fov: {:g} should be 0.01 to 179 degrees", *a.fov);
  if (a.focal35 && !(*a.focal35 > 0.1 && *a.focal35 < 1e5))
    throwInput("--focal35: {:g} should be 0.1 to 100000 millimetres", *a.focal35);
  if (a.height && !(*a.height > 0 && *a.height <= kLargestCoordinate))
    throwInput("--height: {:g} should be in metres, above 0, at most {:g}", *a.height,
               kLargestCoordinate);
  if (a.up != "y" && a.up != "z") throwInput("--up: `{}` should be y or z", a.up);
  checkOutputFile(a.output, {".toml"});
  if (!a.preview.empty()) checkWritable(a.preview);
  checkDistinct({a.output, a.preview}, {a.model, a.plate, a.points, a.lines, a.fspy});
}

Scene loadModels(const std::string& path, Messages& messages) {
  const auto warn = [&](const std::string& line) {
    messages.push_back({Message::Kind::Warning, line});
  };
  Scene scene;
  for (const ModelEntry& model : openScene(path).models) {
    GltfChoice choice = model.choice;
    choice.environment = false;
    append(scene, loadGltf(model.file, model.placement, warn, choice));
  }
  return scene;
}

dvec2 pairOf(const std::string& text, const char* option) {
  const std::vector<double> numbers = parseNumbers(text, 2, option);
  for (const double number : numbers)
    if (std::fabs(number) > kLargestCoordinate)
      throwInput("{}: {} should be between {:g} and {:g}", option, number, -kLargestCoordinate,
                 kLargestCoordinate);
  return {numbers[0], numbers[1]};
}

CameraKnowledge knowledgeOf(const CameraSolveArguments& a, const ImageSize& size) {
  CameraKnowledge known{.size = size, .findsDistortion = a.distortion};
  if (!a.principalPoint.empty())
    known.principalPoint = pairOf(a.principalPoint, "--principal-point");
  if (a.fov) known.focalLength = focalLengthOfFov(size, glm::radians(*a.fov));
  if (a.focal35) known.focalLength = focalLengthOf35mm(size, *a.focal35);
  return known;
}

// If a photograph has too few points to find the field of view, the file itself may state it.
void addExif(const std::string& plate, size_t points, CameraKnowledge& known) {
  if (known.focalLength || points >= fewestPoints(known)) return;
  const auto focal35 = readExif(plate).focalLength35;
  if (!focal35) return;
  print(Messages{
      makeNote("{}: its EXIF tells a focal length of {:g} mm on 35 mm film", plate, *focal35)});
  known.focalLength = focalLengthOf35mm(known.size, *focal35);
}

struct Solution {
  std::string method;  // "points", "lines" or "fspy"
  SolvedCamera camera;
  std::optional<CameraFit> fit;  // not of fspy
  std::vector<ObservedPoint> points;
  std::vector<std::string> names;  // of the points or lines
};

Solution solve(const CameraSolveArguments& a, const ImageSize& size) {
  Solution s;
  CameraKnowledge known = knowledgeOf(a, size);
  if (!a.fspy.empty()) {
    s.method = "fspy";
    s.camera = readFspy(a.fspy, a.up == "z");
    const ImageSize& own = s.camera.size;
    if (std::abs(double(own.width) * size.height - double(size.width) * own.height) >
        own.width + own.height)
      throwInput("{}: is of a photograph of {}x{} pixels, and {} has {}x{}", a.fspy, own.width,
                 own.height, a.plate, size.width, size.height);
    return s;
  }
  if (!a.points.empty()) {
    s.method = "points";
    s.points = readObservedPoints(a.points);
    addExif(a.plate, s.points.size(), known);
    s.fit = solveByPoints(s.points, known, a.points);
    for (const ObservedPoint& point : s.points) s.names.push_back(point.name);
  } else {
    s.method = "lines";
    LinePlacement placement{.height = a.height, .origin = {}};
    if (!a.origin.empty()) placement.origin = pairOf(a.origin, "--origin");
    const std::vector<ObservedLine> lines = readObservedLines(a.lines);
    s.fit = solveByLines(lines, known, placement, a.lines);
    for (const ObservedLine& line : lines) s.names.push_back(line.location);
  }
  s.camera = s.fit->camera;
  return s;
}

std::string withError(const std::string& value, std::optional<double> error) {
  if (!error) return value;
  return std::isfinite(*error) ? fmt::format("{} +- {:.2g}", value, *error) : value + " +- unknown";
}

// "points      12, RMS 0.43 pixels, worst `lamp` 0.91 pixels", and so on.
std::vector<std::string> reportLines(const Solution& report) {
  const SolvedCamera& camera = report.camera;
  static const CameraErrors none;  // a reference: GCC 12 warns wrongly of a copy's members
  const CameraErrors& errors = report.fit ? report.fit->errors : none;
  std::vector<std::string> lines;
  if (const auto& fit = report.fit)
    lines.push_back(fmt::format("{:<12}{}, RMS {:.3g} pixels, worst `{}` {:.3g} pixels",
                                report.method, report.names.size(), fit->rms(),
                                report.names[fit->worst()], fit->distances[fit->worst()]));
  const dvec3& p = camera.position;
  std::string position = fmt::format("{:.5g} {:.5g} {:.5g}", p.x, p.y, p.z);
  if (const auto& e = errors.position)
    position += fmt::format(" +- {:.2g} {:.2g} {:.2g}", e->x, e->y, e->z);
  lines.push_back(fmt::format("{:<12}{} m", "position", position));
  const dvec3 view = dvec3(0) - camera.axes[2];  // without a negative 0
  lines.push_back(fmt::format("{:<12}{:.5f} {:.5f} {:.5f}", "looks along", view.x, view.y, view.z));
  if (report.fit) {
    const dvec3 e = glm::degrees(errors.rotation);
    const auto text = [](double x) {
      return std::isfinite(x) ? fmt::format("{:.2g}", x) : std::string("unknown");
    };
    lines.push_back(fmt::format("{:<12}+- {} {} {} degrees about the right, up and back axes",
                                "rotation", text(e.x), text(e.y), text(e.z)));
  }
  const auto fovError = errors.fov ? std::optional(glm::degrees(*errors.fov)) : std::nullopt;
  lines.push_back(
      fmt::format("{:<12}{} degrees vertically, {:.4g} mm on 35 mm film{}", "fov",
                  withError(fmt::format("{:.5g}", glm::degrees(camera.fov())), fovError),
                  equivalentOn35mm(camera.size, camera.focalLength),
                  report.fit && !fovError ? " (given)" : ""));
  if (camera.distortion)
    lines.push_back(fmt::format("{:<12}{}", "k1",
                                withError(fmt::format("{:.5g}", camera.distortion.k1), errors.k1)));
  return lines;
}

JsonValue toJson(const Solution& report) {
  const SolvedCamera& camera = report.camera;
  JsonValue json = {{"method", report.method},
                    {"size", {camera.size.width, camera.size.height}},
                    {"position", vectorToJson(camera.position)},
                    {"look_at", vectorToJson(lookAt(camera))},
                    {"up", vectorToJson(camera.axes[1])},
                    {"fov", glm::degrees(camera.fov())},
                    {"focal_length_35mm", equivalentOn35mm(camera.size, camera.focalLength)},
                    {"principal_point", {camera.principalPoint.x, camera.principalPoint.y}},
                    {"distortion", {camera.distortion.k1, camera.distortion.k2}}};
  const auto& fit = report.fit;
  if (!fit) return json;
  JsonValue errors = {{"rotation", vectorToJson(glm::degrees(fit->errors.rotation))}};
  if (const auto& e = fit->errors.position) errors["position"] = vectorToJson(*e);
  if (const auto& e = fit->errors.fov) errors["fov"] = glm::degrees(*e);
  if (const auto& e = fit->errors.k1) errors["k1"] = *e;
  json["errors"] = errors;
  json["rms"] = fit->rms();
  json["worst"] = report.names[fit->worst()];
  if (fit->rivalRms) json["rival_rms"] = *fit->rivalRms;
  for (size_t i = 0; i < report.names.size(); ++i)
    json["distances"].push_back({{"name", report.names[i]}, {"pixels", fit->distances[i]}});
  return json;
}

// The picked points are crosses, where the camera sees them are circles.
void writePreview(const std::string& path, const Scene& scene, const Solution& solution,
                  Image picture) {
  const Rgb kWires(0.1f, 1, 0.1f), kPicked(1, 0.05f, 0.05f), kSeen(1, 1, 0.1f);
  const Camera camera = solution.camera.camera();
  drawEdges(creases(scene), camera, kWires, picture);
  const dvec2 size(picture.width, picture.height);
  const CameraView view(camera, size.x / size.y);
  PictureLines marks(picture);
  for (const ObservedPoint& point : solution.points) {
    marks.cross(point.pixel, kPicked);
    if (const auto seen = view.at(point.position)) marks.circle(size * seen->position, kSeen);
  }
  print(writeImage(path, picture));
}

void run(const CameraSolveArguments& a, const Command& command) {
  check(a, command);
  Messages messages;
  Image plate = readPlate(a.plate, &messages);
  const Scene scene = loadModels(a.model, messages);
  checkDistinct({a.output, a.preview}, scene.files);
  const Solution solution = solve(a, {plate.width, plate.height});
  const std::vector<std::string> lines = reportLines(solution);
  std::vector<std::string> comments{
      fmt::format("The camera of {}, by `chromeball camera solve`.", a.plate)};
  comments.insert(comments.end(), lines.begin(), lines.end());
  if (!a.preview.empty()) writePreview(a.preview, scene, solution, std::move(plate));
  writeCameraFile(a.output, solution.camera, comments);
  const auto add = [&](const Messages& more) {
    messages.insert(messages.end(), more.begin(), more.end());
  };
  add(doubtsAbout(solution.points, solution.camera.size));
  if (solution.fit) add(doubtsAbout(*solution.fit));
  add(doubtsAbout(solution.camera, bounds(scene)));
  print(messages);
  if (a.json)
    printJson(toJson(solution));
  else
    for (const std::string& line : lines) say("{}\n", line);
}

}  // namespace

void addCameraCommand(Command app) {
  Command camera = app.addCommand("camera", "Find the cameras of photographs.");
  camera.requiresCommand();
  auto [command, a] = camera.addCommand<CameraSolveArguments>(
      "solve",
      "Find where a photograph was taken from, and its field of view: by points of known "
      "positions, or by lines along the scene's axes.",
      run);
  command.addRequired("MODEL", a.model, "the model, .glb or .gltf, or a scene file");
  command.addRequired("PLATE", a.plate, "the photograph");
  command.addOption("--points", a.points,
                    "CSV name,x,y,z,px,py: at least 6 points, or 4 if the field of view is known");
  command.addOption("--lines", a.lines,
                    "CSV axis,x1,y1,x2,y2[,metres]: at least 2 lines along each of 2 axes");
  command.addOption("--fspy", a.fspy, "camera parameters that fSpy exported as JSON");
  command.addRequired("-o,--output", a.output,
                      "the .toml to write; `[camera] file` and --camera-file read it");
  command.addOption("--fov", a.fov, "the vertical field of view in degrees, if it is known");
  command.addOption("--focal35", a.focal35,
                    "the focal length in mm that has the same diagonal field of view on 35 mm "
                    "film, if it is known");
  command.addFlag("--distortion", a.distortion, "find the lens's radial distortion k1 too");
  command.addOption("--principal-point", a.principalPoint,
                    "U,V: where the lens's axis meets the image, as fractions of its size from the "
                    "top left [0.5,0.5]");
  command.addOption("--height", a.height,
                    "height of the camera above the ground y = 0 in metres, for lines");
  command.addOption("--origin", a.origin,
                    "PX,PY: the pixel that shows the point 0, 0, 0 of the ground, for lines");
  command.addWithDefault("--up", a.up,
                         "the axis of fSpy's scene that is up: y, or z as in Blender");
  command.addOption("--preview", a.preview,
                    "an image to write: the model's edges over the photograph, picked points as "
                    "crosses, where the camera sees them as circles");
  command.addFlag("--json", a.json, "print JSON");
  command.footer(
      "Positions px, py are in pixels from the photograph's top left corner. The ends of a line "
      "go\nfrom one to another farther along the positive axis. `metres` is the length of a line "
      "whose\nfirst end is on the ground: the scale; that end is the origin, unless --origin is "
      "given.\n");
}

}  // namespace chromeball
