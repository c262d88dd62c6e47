// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/direction_basis.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "base/error.h"
#include "math/icosphere.h"

namespace chromeball {

// Y_lm = Q_lm(z) times the real (m >= 0) or imaginary (m < 0) part of (x + i y)^|m|, with Q_lm the
// normalised Legendre function divided by sin(theta)^|m|, a polynomial.
void shBasis(const dvec3& d, int order, std::span<double> out) {
  const auto at = [&](int l, int m) -> double& { return out[size_t(l * (l + 1) + m)]; };
  double real = 1, imaginary = 0;  // (x + i y)^m
  double diagonal = std::sqrt(1 / (4 * kPiD));
  for (int m = 0; m <= order; ++m) {
    if (m > 0) {
      diagonal *= std::sqrt((2 * m + 1.) / (2 * m));
      const double next = real * d.x - imaginary * d.y;
      imaginary = real * d.y + imaginary * d.x;
      real = next;
    }
    const double scale = m == 0 ? 1 : std::sqrt(2.);
    double before = 0, q = diagonal;
    for (int l = m; l <= order; ++l) {
      if (l > m) {
        const double a = std::sqrt((4. * l * l - 1) / (l * l - m * m));
        const double b = std::sqrt(((l - 1.) * (l - 1) - m * m) / (4. * (l - 1) * (l - 1) - 1));
        const double next = a * (d.z * q - b * before);
        before = q;
        q = next;
      }
      at(l, m) = scale * q * real;
      if (m > 0) at(l, -m) = scale * q * imaginary;
    }
  }
}

namespace {

constexpr int kMaxSubdivisions = 4;  // 5120 faces

// Parses "AxB" or "A"; nullopt for any other text.
std::optional<std::vector<int>> numbersIn(std::string_view text) {
  std::vector<int> numbers;
  for (;;) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(size_t(end - text.data()));
    if (text.empty()) return numbers;
    if (text.front() != 'x') return std::nullopt;
    text.remove_prefix(1);
  }
}

int indexOf(double position, int count) {
  return std::clamp(int(position * count), 0, count - 1);  // a NaN direction stays in the sphere
}

}  // namespace

DirectionBasis::DirectionBasis(std::string_view name, std::string_view location) : name_(name) {
  const size_t colon = std::min(name.find(':'), name.size());
  const std::string_view kind = name.substr(0, colon);
  const auto numbers = numbersIn(name.substr(std::min(colon + 1, name.size())));
  const auto isIn = [](int number, int least, int most) {
    return number >= least && number <= most;
  };
  const auto one = [&](int least, int most) {
    if (!numbers || numbers->size() != 1 || !isIn(numbers->front(), least, most))
      throwInput("{}: `{}` should be {}:N with N from {} to {}", location, name, kind, least, most);
    return numbers->front();
  };
  if (kind == "lat-long") {
    kind_ = LatLong;
    if (!numbers || numbers->size() != 2 || !isIn(numbers->at(0), 1, kMaxElements) ||
        !isIn(numbers->at(1), 1, kMaxElements / numbers->at(0)))
      throwInput("{}: `{}` should be lat-long:WxH with W times H from 1 to {}", location, name,
                 kMaxElements);
    columns_ = numbers->at(0), rows_ = numbers->at(1);
    size_ = columns_ * rows_;
  } else if (kind == "cube") {
    kind_ = Cube;
    columns_ = rows_ = one(1, 36);
    size_ = 6 * columns_ * rows_;
  } else if (kind == "icosphere") {
    kind_ = Icosphere;
    order_ = one(0, kMaxSubdivisions);
    size_ = 20 << (2 * order_);
  } else if (kind == "sh") {
    kind_ = Sh;
    order_ = one(0, kMaxOrder);
    size_ = shCount(order_);
  } else {
    throwInput("{}: `{}` is not lat-long:WxH, cube:N, icosphere:N or sh:N", location, name);
  }
}

DirectionBasis::DirectionBasis(std::vector<vec3> directions)
    : kind_(Nearest), name_("nearest"), size_(int(directions.size())) {
  directions_ = std::move(directions);
}

int DirectionBasis::cell(const vec3& direction) const {
  switch (kind_) {
    case LatLong: {
      const dvec2 uv = directionToUv(Mapping::LatLong, dvec3(direction));
      return indexOf(uv.y, rows_) * columns_ + indexOf(uv.x, columns_);
    }
    case Cube: {
      const dvec2 uv = directionToUv(Mapping::HorizontalStrip, dvec3(direction));
      const int column = indexOf(uv.x, 6 * columns_);
      return (column / columns_ * rows_ + indexOf(uv.y, rows_)) * columns_ + column % columns_;
    }
    case Icosphere:
      return icosphereFace(direction, order_);
    default:
      break;
  }
  int best = 0;
  float most = -2;
  for (int i = 0; i < size_; ++i)
    if (const float cosine = glm::dot(directions_[size_t(i)], direction); cosine > most)
      most = cosine, best = i;
  return best;
}

std::vector<double> cellSolidAngles(const DirectionBasis& basis) {
  if (basis.kind() == DirectionBasis::LatLong) {
    std::vector<double> boxes;
    for (int i = 0; i < basis.size(); ++i)
      boxes.push_back(texelSolidAngle(i / basis.columns(), basis.columns(), basis.rows()));
    return boxes;
  }
  const bool isSlow = basis.kind() == DirectionBasis::Nearest;
  return sumOverSphere<double>(isSlow ? ImageSize{1024, 512} : ImageSize{4096, 2048},
                               size_t(basis.size()),
                               [&](const dvec3& d, double solidAngle, auto& cells) {
                                 cells[size_t(basis.cell(vec3(d)))] += solidAngle;
                               });
}

}  // namespace chromeball
