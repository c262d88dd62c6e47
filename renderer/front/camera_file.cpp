// SPDX-License-Identifier: Apache-2.0
#include "front/camera_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "image/io/output_file.h"

namespace chromeball {

dvec3 lookAt(const SolvedCamera& camera) {
  const double distance = std::max({camera.distance, glm::length(camera.position), 1e-3});
  return camera.position - distance * camera.axes[2];
}

void writeCameraFile(const std::string& path, const SolvedCamera& camera,
                     const std::vector<std::string>& comments) {
  const auto vector = [](const dvec3& v) {
    return fmt::format("[{:.10g}, {:.10g}, {:.10g}]", v.x, v.y, v.z);
  };
  std::string text;
  for (std::string comment : comments) {
    std::ranges::replace_if(
        comment, [](char c) { return c < ' ' || c > '~'; }, '?');  // it may not be UTF-8
    text += "# " + comment + "\n";
  }
  text += fmt::format("[camera]\nposition = {}\nlook_at = {}\nup = {}\nfov = {:.10g}\n",
                      vector(camera.position), vector(lookAt(camera)), vector(camera.axes[1]),
                      glm::degrees(camera.fov()));
  if (camera.principalPoint != dvec2(0.5))
    text += fmt::format("principal_point = [{:.10g}, {:.10g}]\n", camera.principalPoint.x,
                        camera.principalPoint.y);
  if (camera.distortion)
    text += fmt::format("distortion = [{:.10g}, {:.10g}]\n", camera.distortion.k1,
                        camera.distortion.k2);
  writeText(path, text);
}

}  // namespace chromeball
