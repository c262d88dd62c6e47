// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/optics.h"

#include <complex>

namespace chromeball {

double metalFresnel(double cosIncidence, const MetalIndex& index) {
  using Complex = std::complex<double>;
  const double c = std::clamp(cosIncidence, 0.0, 1.0);
  const Complex eta(index.n, index.k);
  const Complex inside = std::sqrt(eta * eta - (1 - c * c));  // eta times the cosine in the metal
  const Complex across = (c - inside) / (c + inside);
  const Complex along = (eta * eta * c - inside) / (eta * eta * c + inside);
  return 0.5 * (std::norm(across) + std::norm(along));
}

BallReflectance BallReflectance::ofMetal(const glm::dvec3& normal, const MetalIndex& index) {
  BallReflectance reflectance(normal);
  reflectance.index_ = index;
  return reflectance;
}

BallReflectance BallReflectance::schlick(const glm::dvec3& normal) {
  BallReflectance reflectance(normal);
  reflectance.isSchlick_ = true;
  return reflectance;
}

glm::dvec3 BallReflectance::at(double cosIncidence) const {
  if (index_) return normal_ * (metalFresnel(cosIncidence, *index_) / metalFresnel(1, *index_));
  if (isSchlick_)
    return normal_ + (1.0 - normal_) * std::pow(std::clamp(1 - cosIncidence, 0.0, 1.0), 5);
  return normal_;
}

namespace {

// Used only where no other photograph shows the direction.
constexpr double kLeastWeight = 1e-3;

double smoothstep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// The point of the disc at `radius` from the centre, in the direction of (x, y).
dvec2 onDisc(const dvec3& direction, double radius) {
  const double length = std::hypot(direction.x, direction.y);
  return length > 0 ? radius / length * dvec2(direction) : dvec2(radius, 0);
}

}  // namespace

BallOptics::BallOptics(double distance, const BallReflectance& reflectance, double cameraDisc)
    : inverseDistance_(1 / distance),
      reflectance_(reflectance),
      cameraDisc_(cameraDisc * kPiD / 180) {}

// Solves 2i - asin(q sin(i)) = fromCamera, with q = 1/d. The left side is convex, and the start,
// its solution for small angles, not below the root: Newton's method converges from above.
double BallOptics::angleOfIncidence(double fromCamera) const {
  const double q = inverseDistance_;
  double i = std::min(fromCamera / (2 - q), 0.5 * kPiD);
  for (int step = 0; step < 8 && q > 0; ++step) {
    const double sine = q * std::sin(i);
    const double slope = 2 - q * std::cos(i) / std::sqrt(1 - sine * sine);
    const double change = (2 * i - std::asin(sine) - fromCamera) / slope;
    i -= change;
    if (std::fabs(change) < 1e-15) break;
  }
  return std::min(i, 0.5 * kPiD);
}

std::optional<DiscPoint> BallOptics::locate(const dvec3& direction) const {
  const double q = inverseDistance_;
  const double fromCamera = std::atan2(std::hypot(direction.x, direction.y), direction.z);
  if (fromCamera > kPiD - std::asin(q)) return std::nullopt;
  const double i = angleOfIncidence(fromCamera), sine = std::sin(i), cosine = std::cos(i);
  const double radius = sine * std::sqrt((1 - q * q) / (1 - q * q * sine * sine));
  const double awayFromCamera =
      cameraDisc_ > 0 ? std::max(smoothstep(fromCamera / cameraDisc_), kLeastWeight) : 1;
  return DiscPoint{onDisc(direction, radius), smoothstep(cosine) * awayFromCamera,
                   reflectance_.at(cosine)};
}

BallOptics::Reflection BallOptics::reflection(const dvec2& position) const {
  const double q = inverseDistance_, radius = glm::length(position);
  const double sine = std::min(radius / std::sqrt(1 - q * q + q * q * radius * radius), 1.0);
  const double i = std::asin(sine), fromCamera = 2 * i - std::asin(q * sine);
  const dvec2 across = radius > 0 ? position / radius * std::sin(fromCamera) : dvec2(0);
  return {dvec3(across, std::cos(fromCamera)), std::cos(i)};
}

double BallOptics::shareShown() const {
  return 0.5 * (1 + std::sqrt(1 - inverseDistance_ * inverseDistance_));
}

std::optional<DiscPoint> FisheyeOptics::locate(const dvec3& direction) const {
  constexpr double kRounding = 1e-9, kFalloff = 0.1;
  const double radius =
      lens_.radius(std::atan2(std::hypot(direction.x, direction.y), -direction.z));
  if (radius > 1 + kRounding) return std::nullopt;
  return DiscPoint{onDisc(direction, std::min(radius, 1.0)),
                   std::max(smoothstep((1 - radius) / kFalloff), kLeastWeight), dvec3(1)};
}

double FisheyeOptics::shareShown() const { return lens_.solidAngle() / (4 * kPiD); }

}  // namespace chromeball
