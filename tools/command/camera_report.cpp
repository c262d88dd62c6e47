// SPDX-License-Identifier: Apache-2.0
#include "camera_report.h"

#include <fmt/format.h>

#include "base/json_text.h"
#include "front/scene_file_camera.h"
#include "json_values.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

std::string withError(const std::string& value, std::optional<double> error) {
  if (!error) return value;
  return std::isfinite(*error) ? fmt::format("{} +- {:.2g}", value, *error) : value + " +- unknown";
}

}  // namespace

std::vector<std::string> reportLines(const CameraReport& report) {
  const SolvedCamera& camera = report.camera;
  static const CameraErrors none;  // a reference: GCC 12 warns wrongly of a copy's members
  const CameraErrors& errors = report.fit ? report.fit->errors : none;
  std::vector<std::string> lines;
  if (const CameraFit* fit = report.fit)
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

std::string reportJson(const CameraReport& report) {
  const SolvedCamera& camera = report.camera;
  Json json = {{"method", report.method},
               {"size", {camera.size.width, camera.size.height}},
               {"position", vectorToJson(camera.position)},
               {"look_at", vectorToJson(lookAt(camera))},
               {"up", vectorToJson(camera.axes[1])},
               {"fov", glm::degrees(camera.fov())},
               {"focal_length_35mm", equivalentOn35mm(camera.size, camera.focalLength)},
               {"principal_point", {camera.principalPoint.x, camera.principalPoint.y}},
               {"distortion", {camera.distortion.k1, camera.distortion.k2}}};
  const CameraFit* fit = report.fit;
  if (!fit) return jsonText(json, 2);
  Json errors = {{"rotation", vectorToJson(glm::degrees(fit->errors.rotation))}};
  if (const auto& e = fit->errors.position) errors["position"] = vectorToJson(*e);
  if (const auto& e = fit->errors.fov) errors["fov"] = glm::degrees(*e);
  if (const auto& e = fit->errors.k1) errors["k1"] = *e;
  json["errors"] = errors;
  json["rms"] = fit->rms();
  json["worst"] = report.names[fit->worst()];
  if (fit->rivalRms) json["rival_rms"] = *fit->rivalRms;
  for (size_t i = 0; i < report.names.size(); ++i)
    json["distances"].push_back({{"name", report.names[i]}, {"pixels", fit->distances[i]}});
  return jsonText(json, 2);
}

}  // namespace chromeball
