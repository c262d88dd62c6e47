// SPDX-License-Identifier: Apache-2.0
#include "probe/map_moments.h"

#include "base/parallel.h"
#include "probe/irradiance.h"

namespace chromeball {
namespace {

// The integral of the direction over the rectangle.
dvec3 meanDirection(const MapRectangle& r) {
  const PolarMoments polar(r.theta0, r.theta1);
  return {polar.sine2 * (std::cos(r.phi1) - std::cos(r.phi0)), polar.sineCosine * (r.phi1 - r.phi0),
          polar.sine2 * (std::sin(r.phi1) - std::sin(r.phi0))};
}

double sumOf(const dvec3& c) { return c.x + c.y + c.z; }
double sumOf(const Rgb& c) { return sumOf(dvec3(c)); }

// Of a rectangle of constant radiance, about.
double evenSpread(const RectangleGeometry& g) { return g.radius * g.radius / 3; }

}  // namespace

MapRectangle MapRectangle::quarter(int i) const {
  const double phi = (phi0 + phi1) / 2, theta = (theta0 + theta1) / 2;
  return {i % 2 == 0 ? phi0 : phi, i % 2 == 0 ? phi : phi1, i < 2 ? theta0 : theta,
          i < 2 ? theta : theta1};
}

RectangleGeometry::RectangleGeometry(const MapRectangle& r) {
  const double width = r.phi1 - r.phi0, height = r.theta1 - r.theta0;
  const double middle = (r.theta0 + r.theta1) / 2, halfPi = kPiD / 2;
  solidAngle = 2 * width * std::sin(middle) * std::sin(height / 2);
  const dvec3 direction = meanDirection(r);
  directionLength = glm::length(direction);
  centre = directionLength > 0 ? direction / directionLength : dvec3(0, 1, 0);
  // The centre is on the meridian in the middle.
  const double widest =
      r.theta0 < halfPi && r.theta1 > halfPi ? 1 : std::max(std::sin(r.theta0), std::sin(r.theta1));
  const double polar = std::acos(std::clamp(centre.y, -1.0, 1.0));
  radius = std::max(polar - r.theta0, r.theta1 - polar) + widest * width / 2;
}

RadianceMoments::RadianceMoments(const dvec3& radiance, const RectangleGeometry& geometry)
    : flux(geometry.solidAngle * radiance) {
  for (int axis = 0; axis < 3; ++axis)
    offset[axis] =
        (geometry.directionLength - geometry.solidAngle) * geometry.centre[axis] * radiance;
}

MapMoments::MapMoments(const Image& latLong) : map_(&latLong) {
  for (int level = 1; columnsOf(level - 1) > 1 || rowsOf(level - 1) > 1; ++level) {
    const int columns = columnsOf(level);
    std::vector<Stored> nodes(size_t(columns) * rowsOf(level), Stored{RectangleGeometry({})});
    parallelFor(0, rowsOf(level), [&](int y) {
      for (int x = 0; x < columns; ++x)
        nodes[size_t(y) * columns + x] = sumOfChildren({level, x, y});
    });
    stored_.push_back(std::move(nodes));
  }
  flux_ = sumOf(moments(root(), geometry(root())).flux);
}

MapRectangle MapMoments::rectangle(const Node& node) const {
  const auto edge = [&](int index, int size) {
    return std::min(double(index) * double(1 << node.level), double(size)) / size;
  };
  return {2 * kPiD * edge(node.x, map_->width), 2 * kPiD * edge(node.x + 1, map_->width),
          kPiD * edge(node.y, map_->height), kPiD * edge(node.y + 1, map_->height)};
}

dvec3 MapMoments::radiance(const Node& texel) const { return {map_->rgb(texel.x, texel.y)}; }

RectangleGeometry MapMoments::geometry(const Node& node) const {
  return node.level > 0 ? stored(node).geometry : RectangleGeometry(rectangle(node));
}

RadianceMoments MapMoments::moments(const Node& node, const RectangleGeometry& geometry) const {
  if (node.level == 0) return {radiance(node), geometry};
  const Stored& s = stored(node);
  RadianceMoments moments;
  moments.flux = s.flux;
  for (int axis = 0; axis < 3; ++axis) moments.offset[axis] = s.offset[axis];
  return moments;
}

LightSpread MapMoments::spread(const dvec3& radiance, const RectangleGeometry& geometry) const {
  const double flux = sumOf(radiance) * geometry.solidAngle;
  return {evenSpread(geometry), 1, flux > 0 ? flux / flux_ : 0};
}

LightSpread MapMoments::spread(const Node& node, const RectangleGeometry& geometry) const {
  if (node.level == 0) return spread(radiance(node), geometry);
  const Stored& s = stored(node);
  const double flux = sumOf(s.flux);
  if (!(flux > 0)) return {evenSpread(geometry), 1, 0};
  return {double(s.squaredSpread), double(s.peak) * geometry.solidAngle / flux, flux / flux_};
}

MapMoments::Stored MapMoments::sumOfChildren(const Node& node) const {
  Stored sum{RectangleGeometry(rectangle(node))};
  RadianceMoments total;
  double squares = 0;  // flux times squared chords
  forChildren(node, [&](const Node& child) {
    const RectangleGeometry g = geometry(child);
    const RadianceMoments m = moments(child, g);
    const dvec3 shift = g.centre - sum.geometry.centre;
    total.flux += m.flux;
    const double own = child.level > 0 ? double(stored(child).squaredSpread) : evenSpread(g);
    squares += (own + glm::dot(shift, shift)) * sumOf(m.flux);
    for (int axis = 0; axis < 3; ++axis) {
      total.offset[axis] += m.offset[axis] + shift[axis] * m.flux;
      squares += 2 * shift[axis] * sumOf(m.offset[axis]);
    }
    sum.peak =
        std::max(sum.peak, child.level > 0 ? stored(child).peak : float(sumOf(radiance(child))));
  });
  sum.flux = total.flux;
  const double flux = sumOf(total.flux);
  sum.squaredSpread = float(flux > 0 ? std::max(squares / flux, 0.0) : evenSpread(sum.geometry));
  for (int axis = 0; axis < 3; ++axis) sum.offset[axis] = total.offset[axis];
  return sum;
}

}  // namespace chromeball
