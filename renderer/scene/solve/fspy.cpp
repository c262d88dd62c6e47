// SPDX-License-Identifier: Apache-2.0
#include "scene/solve/fspy.h"

#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "base/json_text.h"
#include "scene/solve/observations.h"

namespace chromeball {
namespace {

using Json = nlohmann::ordered_json;

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path.string()) {
    constexpr size_t kMaxBytes = 1 << 20;
    checkReadable(path);
    if (std::filesystem::file_size(path) > kMaxBytes)
      throwInput("{}: is too long for the camera parameters of fSpy", path_);
    const std::vector<uint8_t> bytes = readFile(path);
    root_ = readJson({bytes.begin(), bytes.end()});
    if (!root_.is_object())
      throwInput(
          "{}: is not JSON with the camera parameters of fSpy; a project (.fspy) is not: "
          "export them",
          path_);
  }

  // The number at a path such as "/principalPoint/x", between `least` and `most`.
  double number(const std::string& pointer, double least = -kLargestCoordinate,
                double most = kLargestCoordinate) const {
    const Json::json_pointer at(pointer);
    const double value =
        root_.contains(at) && root_[at].is_number() ? root_[at].get<double>() : NAN;
    if (!(value > least && value < most))
      fail(pointer, fmt::format("a number between {:g} and {:g}", least, most));
    return value;
  }

  [[noreturn]] void fail(const std::string& pointer, const std::string& wanted) const {
    throwInput("{}: `{}` should be {}", path_, pointer.substr(1), wanted);
  }

 private:
  std::string path_;
  Json root_;
};

dvec3 turnedUp(const dvec3& v) { return {v.x, v.z, -v.y}; }

}  // namespace

SolvedCamera readFspy(const std::filesystem::path& path, bool zUp) {
  constexpr double kTolerance = 1e-3, kMostPixels = 1e6;
  const Reader file(path);
  SolvedCamera camera;
  camera.size = {int(file.number("/imageWidth", 0, kMostPixels)),
                 int(file.number("/imageHeight", 0, kMostPixels))};
  if (camera.size.width < 1 || camera.size.height < 1) file.fail("/imageWidth", "1 or more");
  const double fov = file.number("/verticalFieldOfView", 0, kPiD);
  camera.focalLength = focalLengthOfFov(camera.size, fov);
  for (int row = 0; row < 3; ++row) {
    const auto at = [&](int column) {
      return file.number(fmt::format("/cameraTransform/rows/{}/{}", row, column));
    };
    for (int column = 0; column < 3; ++column) camera.axes[column][row] = at(column);
    camera.position[row] = at(3);
  }
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(glm::dot(camera.axes[i], camera.axes[k]) - (i == k)) < kTolerance))
        file.fail("/cameraTransform", "a rotation and a translation");
  if (!(glm::determinant(camera.axes) > 0)) file.fail("/cameraTransform", "no reflection");
  camera.axes[0] = glm::normalize(camera.axes[0]);
  camera.axes[2] = glm::normalize(glm::cross(camera.axes[0], camera.axes[1]));
  camera.axes[1] = glm::cross(camera.axes[2], camera.axes[0]);
  const double longer = std::max(camera.size.width, camera.size.height);
  camera.principalPoint.x =
      0.5 + 0.5 * longer / camera.size.width * file.number("/principalPoint/x");
  camera.principalPoint.y =
      0.5 - 0.5 * longer / camera.size.height * file.number("/principalPoint/y");
  if (zUp) {
    camera.position = turnedUp(camera.position);
    for (int i = 0; i < 3; ++i) camera.axes[i] = turnedUp(camera.axes[i]);
  }
  camera.distance = glm::length(camera.position);
  return camera;
}

}  // namespace chromeball
