// SPDX-License-Identifier: Apache-2.0
#include "probe/mapping.h"

#include <array>
#include <vector>

#include "base/error.h"
#include "base/text.h"

namespace chromeball {
namespace {

struct Face {
  int column, row;
  dvec3 forward, up;
  dvec3 right() const { return glm::cross(forward, up); }
};

constexpr dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

// The front face comes first, so that it gets directions on its edges.
std::array<Face, 6> crossFaces(const Face& back) {
  return {
      {{1, 1, -kZ, kY}, {0, 1, -kX, kY}, {2, 1, kX, kY}, {1, 0, kY, kZ}, {1, 2, -kY, -kZ}, back}};
}

std::array<Face, 6> stripFaces(int columns) {
  const std::pair<dvec3, dvec3> kAxes[] = {{kX, kY},   {-kX, kY}, {kY, kZ},
                                           {-kY, -kZ}, {kZ, kY},  {-kZ, kY}};
  std::array<Face, 6> faces;
  for (int i = 0; i < 6; ++i)
    faces[size_t(i)] = {i % columns, i / columns, kAxes[i].first, kAxes[i].second};
  return faces;
}

const std::array<Face, 6>& facesOf(Mapping mapping) {
  static const std::array<Face, 6> kFaces[] = {crossFaces({1, 3, kZ, -kY}),
                                               crossFaces({3, 1, kZ, kY}), stripFaces(6),
                                               stripFaces(1), stripFaces(3)};
  return kFaces[mapping.kind() - Mapping::VerticalCross];
}

struct KindOfMapping {
  std::string_view name, shape;
  Layout layout;
};

// In the order of Mapping::Kind.
constexpr KindOfMapping kKinds[] = {{"lat-long", "of any shape", {1, 1}},
                                    {"angular", "square", {1, 1}},
                                    {"mirror-ball", "square", {1, 1}},
                                    {"cube-cross", "3:4 or 4:3, of square faces", {3, 4}},
                                    {"cube-cross", "3:4 or 4:3, of square faces", {4, 3}},
                                    {"cube-strip", "6:1 or 1:6, of square faces", {6, 1}},
                                    {"cube-strip", "6:1 or 1:6, of square faces", {1, 6}},
                                    {"cube-3x2", "3:2, of square faces", {3, 2}},
                                    {"fisheye", "square", {1, 1}}};

dvec2 directionToCube(Mapping mapping, const dvec3& d) {
  const std::array<Face, 6>& faces = facesOf(mapping);
  const Face& face =
      *std::max_element(faces.begin(), faces.end(), [&](const Face& a, const Face& b) {
        return glm::dot(a.forward, d) < glm::dot(b.forward, d);
      });
  const double depth = glm::dot(face.forward, d);
  // Rounding must not move a direction on an edge out of the chosen face: faces that touch in the
  // image need not touch on the cube.
  constexpr double kInside = 1e-14;
  const auto inFace = [&](const dvec3& axis) {
    return std::clamp(0.5 * (1 + glm::dot(axis, d) / depth), kInside, 1 - kInside);
  };
  const auto [columns, rows] = faceLayout(mapping);
  return {(face.column + inFace(face.right())) / columns, (face.row + inFace(-face.up)) / rows};
}

std::optional<dvec3> cubeToDirection(Mapping mapping, const dvec2& uv) {
  const auto [columns, rows] = faceLayout(mapping);
  const double x = uv.x * columns, y = uv.y * rows;
  for (const Face& face : facesOf(mapping)) {
    const double s = 2 * (x - face.column) - 1, t = 1 - 2 * (y - face.row);
    if (std::fabs(s) <= 1 && std::fabs(t) <= 1)
      return glm::normalize(face.forward + s * face.right() + t * face.up);
  }
  return std::nullopt;
}

dvec2 directionToDisc(const Fisheye& lens, const dvec3& d) {
  const double length = std::sqrt(d.x * d.x + d.y * d.y);
  const double radius = lens.radius(std::atan2(length, -d.z));
  if (length == 0) return {0.5 + 0.5 * radius, 0.5};
  return {0.5 + 0.5 * radius * d.x / length, 0.5 - 0.5 * radius * d.y / length};
}

std::optional<dvec3> discToDirection(const Fisheye& lens, const dvec2& uv) {
  const double x = 2 * uv.x - 1, y = 1 - 2 * uv.y;
  const double radius = std::sqrt(x * x + y * y);
  if (radius > 1) return std::nullopt;
  if (radius == 0) return -kZ;
  const double theta = lens.angle(radius);
  const double scale = std::sin(theta) / radius;
  return dvec3(scale * x, scale * y, -std::cos(theta));
}

bool fits(Mapping mapping, int width, int height) {
  const auto [columns, rows] = faceLayout(mapping);
  if (mapping == Mapping::LatLong) return true;
  return width % columns == 0 && height % rows == 0 && width / columns == height / rows;
}

// The solid angle of the rectangle from (0, 0) to (x, y) in a plane at distance 1.
double cornerSolidAngle(double x, double y) {
  return std::atan2(x * y, std::sqrt(1 + x * x + y * y));
}

// The solid angle of a texel of a cube's face with `side` texels.
double faceTexelSolidAngle(int x, int y, int side) {
  const auto at = [&](int column, int row) {
    return cornerSolidAngle(2. * column / side - 1, 2. * row / side - 1);
  };
  return at(x + 1, y + 1) - at(x, y + 1) - at(x + 1, y) + at(x, y);
}

}  // namespace

std::optional<Fisheye> Mapping::disc() const {
  switch (kind_) {
    case AngularMap:
      return Fisheye{360, FisheyeProjection::Equidistant};
    case MirrorBall:
      return Fisheye{360, FisheyeProjection::Equisolid};
    case FisheyeDisc:
      return lens_;
    default:
      return std::nullopt;
  }
}

Layout faceLayout(Mapping mapping) { return kKinds[mapping.kind()].layout; }

dvec2 directionToUv(Mapping mapping, const dvec3& d) {
  if (const std::optional<Fisheye> lens = mapping.disc()) return directionToDisc(*lens, d);
  if (mapping == Mapping::LatLong)
    return {0.5 * (1 + std::atan2(d.x, -d.z) / kPiD), std::atan2(std::hypot(d.x, d.z), d.y) / kPiD};
  return directionToCube(mapping, d);
}

bool showsDirection(Mapping mapping, const dvec2& uv) {
  if (!mapping.disc()) return uvToDirection(mapping, uv).has_value();
  const dvec2 fromCentre = 2.0 * uv - 1.0;
  return std::sqrt(glm::dot(fromCentre, fromCentre)) <= 1;
}

std::optional<dvec3> uvToDirection(Mapping mapping, const dvec2& uv) {
  if (!(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1)) return std::nullopt;
  if (const std::optional<Fisheye> lens = mapping.disc()) return discToDirection(*lens, uv);
  if (mapping != Mapping::LatLong) return cubeToDirection(mapping, uv);
  const double phi = kPiD * (2 * uv.x - 1), theta = kPiD * uv.y;
  const double sinTheta = std::sin(theta);
  return dvec3(sinTheta * std::sin(phi), std::cos(theta), -sinTheta * std::cos(phi));
}

dvec3 directionAt(double azimuth, double elevation) {
  const double a = azimuth * kPiD / 180, e = elevation * kPiD / 180;
  return {-std::sin(a) * std::cos(e), std::sin(e), -std::cos(a) * std::cos(e)};
}

dvec3 texelDirection(const ImageSize& latLong, int x, int y) {
  return *uvToDirection(Mapping::LatLong, {(x + 0.5) / latLong.width, (y + 0.5) / latLong.height});
}

std::string mappingName(Mapping mapping) {
  if (mapping.kind() == Mapping::FisheyeDisc) return fisheyeName(*mapping.disc());
  return std::string(kKinds[mapping.kind()].name);
}

std::optional<Mapping> parseMapping(std::string_view name, int width, int height,
                                    std::string_view location) {
  if (name == "auto") return std::nullopt;
  if (namesFisheye(name)) {
    if (width != height)
      throwInput("{}: an image of {} x {} texels cannot be {}, which is square", location, width,
                 height, name);
    return parseFisheye(name, location);
  }

  std::vector<std::string_view> known{"auto"};
  std::string_view shape;
  for (int kind = Mapping::LatLong; kind <= Mapping::FisheyeDisc; ++kind) {
    const KindOfMapping& named = kKinds[kind];
    if (named.name != known.back()) known.push_back(named.name);
    if (named.name != name) continue;
    if (fits(Mapping::Kind(kind), width, height)) return Mapping::Kind(kind);
    shape = named.shape;
  }
  if (!shape.empty())
    throwInput("{}: an image of {} x {} texels cannot be {}, which is {}", location, width, height,
               name, shape);
  throwInput("{}: unknown mapping `{}`; {}", location, name, didYouMean(name, known));
}

Mapping parseMapping(std::string_view name, std::string_view location) {
  if (namesFisheye(name)) return parseFisheye(name, location);
  for (const Mapping mapping : {Mapping::LatLong, Mapping::AngularMap, Mapping::MirrorBall,
                                Mapping::VerticalCross, Mapping::VerticalStrip, Mapping::CubeGrid})
    if (mappingName(mapping) == name) return mapping;
  throwInput(
      "{}: `{}` should be lat-long, angular, mirror-ball, cube-cross, cube-strip, cube-3x2 or "
      "fisheye[:FOV[:PROJECTION]]",
      location, name);
}

double texelSolidAngle(int row, int width, int height) {
  // cos a - cos b = 2 sin((a + b)/2) sin((b - a)/2), without cancellation near the poles.
  const double middle = kPiD * (row + 0.5) / height, half = 0.5 * kPiD / height;
  return 2 * kPiD / width * 2 * std::sin(middle) * std::sin(half);
}

double solidAngleJacobian(Mapping mapping, const dvec2& uv) {
  if (mapping == Mapping::LatLong) return 2 * kPiD * kPiD * std::sin(kPiD * uv.y);
  if (const std::optional<Fisheye> lens = mapping.disc())
    return 4 * lens->solidAngleJacobian(std::hypot(2 * uv.x - 1, 2 * uv.y - 1));
  // A cube's face spans [-1, 1]^2 at distance 1: d(omega) = (1 + s^2 + t^2)^(-3/2) ds dt.
  const auto [columns, rows] = faceLayout(mapping);
  const double x = uv.x * columns, y = uv.y * rows;
  const double s = 2 * (x - std::floor(x)) - 1, t = 2 * (y - std::floor(y)) - 1;
  return 4 * columns * rows * std::pow(1 + s * s + t * t, -1.5);
}

TexelSolidAngles texelSolidAngles(Mapping mapping, const ImageSize& image) {
  TexelSolidAngles angles{4 * kPiD, 0, 0};
  const auto add = [&](double solidAngle, size_t texels) {
    angles.min = std::min(angles.min, solidAngle);
    angles.max = std::max(angles.max, solidAngle);
    angles.texels += texels;
  };
  const auto [columns, rows] = faceLayout(mapping);
  if (mapping == Mapping::LatLong) {
    for (int y = 0; y < image.height; ++y)
      add(texelSolidAngle(y, image.width, image.height), size_t(image.width));
  } else if (columns * rows > 1) {
    const int side = image.width / columns;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) add(faceTexelSolidAngle(x, y, side), 6);
  } else {
    const double area = 1 / (double(image.width) * image.height);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const dvec2 uv((x + 0.5) / image.width, (y + 0.5) / image.height);
        if (showsDirection(mapping, uv)) add(area * solidAngleJacobian(mapping, uv), 1);
      }
  }
  return angles;
}

dvec3 meanRadiance(const Image& latLong) {
  dvec3 sum(0);
  for (int y = 0; y < latLong.height; ++y) {
    dvec3 row(0);
    for (int x = 0; x < latLong.width; ++x) row += dvec3(latLong.rgb(x, y));
    sum += row * texelSolidAngle(y, latLong.width, latLong.height);
  }
  return sum / (4 * kPiD);
}

}  // namespace chromeball
