// SPDX-License-Identifier: Apache-2.0
#include "probe/fisheye.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "math/vec.h"

namespace chromeball {
namespace {

constexpr std::string_view kFisheye = "fisheye";

struct NamedProjection {
  std::string_view name;
  FisheyeProjection projection;
  double largestFieldOfView;                                // degrees
  double (*radius)(double angle), (*angle)(double radius);  // radius at a focal length of 1
  double (*jacobian)(double half, double angle);  // sin(t) (dt/dr) / r, with r = 1 at half
};

double squared(double x) { return x * x; }

// In the order of FisheyeProjection.
constexpr std::array<NamedProjection, 4> kProjections{
    {{"equidistant", FisheyeProjection::Equidistant, 360,  //
      [](double t) { return t; }, [](double r) { return r; },
      [](double h, double t) { return h * h * (t > 0 ? std::sin(t) / t : 1); }},
     {"equisolid", FisheyeProjection::Equisolid, 360,  //
      [](double t) { return std::sin(0.5 * t); }, [](double r) { return 2 * std::asin(r); },
      [](double h, double) { return 4 * std::sin(0.5 * h) * std::sin(0.5 * h); }},
     {"orthographic", FisheyeProjection::Orthographic, 180,
      // The sine falls again behind the lens: its reflection at 1 goes on rising.
      [](double t) { return t <= 0.5 * kPiD ? std::sin(t) : 2 - std::sin(t); },
      [](double r) { return std::asin(r); },
      [](double h, double t) { return squared(std::sin(h)) / std::cos(t); }},
     {"stereographic", FisheyeProjection::Stereographic, 300,  //
      [](double t) { return std::tan(0.5 * t); }, [](double r) { return 2 * std::atan(r); },
      [](double h, double t) {
        return squared(2 * std::tan(0.5 * h)) * std::pow(std::cos(0.5 * t), 4);
      }}}};

const NamedProjection& projectionOf(FisheyeProjection projection) {
  return kProjections[size_t(projection)];
}

const NamedProjection& projectionNamed(std::string_view name, std::string_view location) {
  std::vector<std::string_view> known;
  for (const NamedProjection& named : kProjections) {
    if (named.name == name) return named;
    known.push_back(named.name);
  }
  throwInput("{}: unknown projection `{}` of a fisheye lens; {}", location, name,
             didYouMean(name, known));
}

}  // namespace

double Fisheye::halfAngle() const { return kPiD * (fieldOfView / 360); }

double Fisheye::solidAngle() const {
  const double sine = std::sin(0.5 * halfAngle());  // 1 - cos(h) = 2 sin^2(h/2)
  return 4 * kPiD * sine * sine;
}

double Fisheye::radius(double t) const {
  return projectionOf(projection).radius(t) / projectionOf(projection).radius(halfAngle());
}

double Fisheye::angle(double r) const {
  return projectionOf(projection).angle(projectionOf(projection).radius(halfAngle()) * r);
}

double Fisheye::solidAngleJacobian(double r) const {
  return projectionOf(projection).jacobian(halfAngle(), angle(r));
}

std::string fisheyeName(const Fisheye& lens) {
  return fmt::format("{}:{}:{}", kFisheye, lens.fieldOfView, projectionOf(lens.projection).name);
}

bool namesFisheye(std::string_view name) {
  return name.starts_with(kFisheye) &&
         (name.size() == kFisheye.size() || name[kFisheye.size()] == ':');
}

Fisheye parseFisheye(std::string_view name, std::string_view location) {
  Fisheye lens;
  std::string_view rest = name.substr(kFisheye.size());
  if (rest.empty()) return lens;
  rest.remove_prefix(1);
  const size_t colon = std::min(rest.find(':'), rest.size());
  const std::string_view degrees = rest.substr(0, colon);
  const NamedProjection& projection =
      colon < rest.size() ? projectionNamed(rest.substr(colon + 1), location) : kProjections[0];
  const auto [end, error] =
      std::from_chars(degrees.data(), degrees.data() + degrees.size(), lens.fieldOfView);
  constexpr double kSmallest = 60;
  if (error != std::errc{} || end != degrees.data() + degrees.size() ||
      !(lens.fieldOfView >= kSmallest && lens.fieldOfView <= projection.largestFieldOfView))
    throwInput("{}: the field of view `{}` of a fisheye lens, {}, should be {} to {} degrees",
               location, degrees, projection.name, kSmallest, projection.largestFieldOfView);
  lens.projection = projection.projection;
  return lens;
}

}  // namespace chromeball
