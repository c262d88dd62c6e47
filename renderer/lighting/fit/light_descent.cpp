// SPDX-License-Identifier: Apache-2.0
#include "lighting/fit/light_descent.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <limits>

#include "base/parallel.h"
#include "base/progress.h"
#include "math/dense_solvers.h"

namespace chromeball {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

using Products = std::vector<PatternProduct>;

// Relative to the diagonal: keeps the matrix regular if two lights have the same direction.
constexpr double kRidge = 1e-12;

Products productsWith(const RadiancePoints& probe, const std::vector<dvec3>& directions) {
  Products products(directions.size());
  parallelFor(size_t(0), directions.size(),
              [&](size_t i) { products[i] = probe.productWith(directions[i]); });
  return products;
}

// Products of the lights' patterns with each other; the ambient pattern is the last row and column.
MatrixXd gramMatrix(const std::vector<dvec3>& directions, bool ambient) {
  const Index n = Index(directions.size());
  MatrixXd gram(n + ambient, n + ambient);
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i <= j; ++i)
      gram(i, j) = gram(j, i) = CosinePair(directions[i], directions[j]).product();
  if (ambient) {
    gram.row(n).setConstant(kAmbientTimesLight);
    gram.col(n).setConstant(kAmbientTimesLight);
    gram(n, n) = kAmbientTimesAmbient;
  }
  return gram;
}

void solveColors(FittedLights& lights, const RadiancePoints& probe, bool ambient,
                 const MatrixXd& gram, const Products& products) {
  const size_t n = lights.directions.size();
  lights.misfit = 0;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> right, colors;
    for (size_t i = 0; i < n; ++i) {
      right.push_back(products[i].product[c]);
      colors.push_back(lights.irradiances[i][c]);
    }
    if (ambient) {
      right.push_back(kAmbientTimesLight * probe.flux()[c]);
      colors.push_back(lights.ambient[c]);
    }
    colors = solveNonnegative({gram.data(), size_t(gram.size())}, right, colors);
    for (size_t i = 0; i < n; ++i) lights.irradiances[i][c] = colors[i];
    if (ambient) lights.ambient[c] = colors[n];
    // At the minimum x.Ax = b.x, so x.Ax/2 - b.x = -b.x/2.
    for (size_t i = 0; i < colors.size(); ++i) lights.misfit -= right[i] * colors[i] / 2;
  }
}

// For lights of unit irradiance: `mixed` has the products of patterns (rows) with derivatives along
// the tangents, two per light (columns); `both` the products of derivatives with each other. The
// ambient pattern, if any, is the last row of `mixed`, which is zero.
struct DerivativeProducts {
  MatrixXd mixed, both;
};

DerivativeProducts derivativeProducts(const std::vector<dvec3>& d, bool ambient) {
  const Index n = Index(d.size());
  std::vector<Tangents> tangents;
  for (const dvec3& direction : d) tangents.push_back(tangentsOf(direction));
  DerivativeProducts p{MatrixXd::Zero(n + ambient, 2 * n), MatrixXd(2 * n, 2 * n)};
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i <= j; ++i) {
      const CosinePair pair(d[i], d[j]);
      const dvec3 atI[2] = {tangents[i].s, tangents[i].u}, atJ[2] = {tangents[j].s, tangents[j].u};
      for (int u = 0; u < 2; ++u) {
        p.mixed(i, 2 * j + u) = pair.slope(dot(d[i], atJ[u]));
        p.mixed(j, 2 * i + u) = pair.slope(dot(d[j], atI[u]));
        for (int v = 0; v < 2; ++v)
          p.both(2 * i + u, 2 * j + v) = p.both(2 * j + v, 2 * i + u) =
              pair.slopeProduct(dot(atI[u], atJ[v]), dot(atI[u], d[j]), dot(d[i], atJ[v]));
      }
    }
  return p;
}

// The irradiances of channel c, each twice: once per tangent.
VectorXd twice(const FittedLights& lights, int c) {
  VectorXd colors(2 * lights.irradiances.size());
  for (size_t i = 0; i < lights.irradiances.size(); ++i)
    colors[2 * i] = colors[2 * i + 1] = lights.irradiances[i][c];
  return colors;
}

VectorXd gradient(const FittedLights& lights, const Products& products, const MatrixXd& mixed) {
  const size_t n = lights.directions.size();
  VectorXd result = VectorXd::Zero(2 * n);
  for (int c = 0; c < 3; ++c) {
    VectorXd colors(n), fromProbe(2 * n);
    for (size_t i = 0; i < n; ++i) {
      const Tangents t = tangentsOf(lights.directions[i]);
      colors[i] = lights.irradiances[i][c];
      fromProbe[2 * i] = dot(products[i].slope[c], t.s);
      fromProbe[2 * i + 1] = dot(products[i].slope[c], t.u);
    }
    const VectorXd fromLights = mixed.topRows(n).transpose() * colors;
    result += twice(lights, c).cwiseProduct(fromLights - fromProbe);
  }
  return result;
}

// A quadratic model of the misfit as a function of the directions, two unknowns per light, with the
// colours eliminated: its gradient, and the Gauss-Newton part of its Hessian (the lower triangle is
// used).
struct QuadraticModel {
  MatrixXd hessian;
  VectorXd gradient;
  VectorXd damping;  // the Hessian's diagonal before elimination
};

QuadraticModel modelAround(const FittedLights& lights, bool ambient, const MatrixXd& gram,
                           const Products& products) {
  const Index n = Index(lights.directions.size());
  const auto [mixed, both] = derivativeProducts(lights.directions, ambient);
  QuadraticModel model{MatrixXd::Zero(2 * n, 2 * n), gradient(lights, products, mixed),
                       VectorXd::Zero(2 * n)};
  for (int c = 0; c < 3; ++c) {
    std::vector<Index> lit;  // the colours that are not at their bound of zero
    for (Index i = 0; i < n; ++i)
      if (lights.irradiances[i][c] > 0) lit.push_back(i);
    if (ambient && lights.ambient[c] > 0) lit.push_back(n);
    MatrixXd block = gram(lit, lit);
    block.diagonal() *= 1 + kRidge;
    MatrixXd eliminated = mixed(lit, Eigen::all);
    block.llt().matrixL().solveInPlace(eliminated);
    MatrixXd remaining = both;
    remaining.selfadjointView<Eigen::Lower>().rankUpdate(eliminated.transpose(), -1);
    const VectorXd colors = twice(lights, c);
    for (Index j = 0; j < 2 * n; ++j)
      model.hessian.col(j) += colors[j] * colors.cwiseProduct(remaining.col(j));
    model.damping += colors.cwiseProduct(colors).cwiseProduct(both.diagonal());
  }
  return model;
}

VectorXd stepOf(const QuadraticModel& model, double damping) {
  MatrixXd damped = model.hessian;  // only the lower triangle is used
  // The row of a black light is zero; any positive diagonal keeps the matrix definite.
  const double minimum = std::max(kRidge * model.damping.maxCoeff(), 1e-300);
  damped.diagonal() += damping * model.damping.cwiseMax(minimum);
  return damped.llt().solve(-model.gradient);
}

constexpr double kMaxStep = 0.3;          // radians
constexpr double kNegligibleGain = 1e-4;  // of a step, relative to the gain of all steps

std::vector<dvec3> moved(const std::vector<dvec3>& directions, const VectorXd& step) {
  std::vector<dvec3> result;
  for (size_t i = 0; i < directions.size(); ++i) {
    const Tangents t = tangentsOf(directions[i]);
    dvec3 move = step[2 * i] * t.s + step[2 * i + 1] * t.u;
    move *= kMaxStep / std::max(length(move), kMaxStep);
    result.push_back(normalize(directions[i] + move));
  }
  return result;
}

}  // namespace

void solveColors(FittedLights& lights, const RadiancePoints& probe, bool ambient) {
  solveColors(lights, probe, ambient, gramMatrix(lights.directions, ambient),
              productsWith(probe, lights.directions));
}

std::vector<double> misfitGradient(const FittedLights& lights, const RadiancePoints& probe) {
  const VectorXd g = gradient(lights, productsWith(probe, lights.directions),
                              derivativeProducts(lights.directions, false).mixed);
  return {g.begin(), g.end()};
}

Tangents tangentsOf(const dvec3& direction) {
  const dvec3 other = std::fabs(direction.y) < 0.7 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
  const dvec3 s = normalize(cross(other, direction));
  return {s, cross(direction, s)};
}

void descend(FittedLights& lights, const RadiancePoints& probe, bool ambient, int maxSteps) {
  MatrixXd gram = gramMatrix(lights.directions, ambient);
  Products products = productsWith(probe, lights.directions);
  const double start = lights.misfit;
  solveColors(lights, probe, ambient, gram, products);
  QuadraticModel model = modelAround(lights, ambient, gram, products);
  double damping = 1e-3;
  for (int step = 0; step < maxSteps && damping < 1e6; ++step) {
    endIfCancelled();
    FittedLights candidate = lights;
    candidate.directions = moved(lights.directions, stepOf(model, damping));
    gram = gramMatrix(candidate.directions, ambient);
    products = productsWith(probe, candidate.directions);
    solveColors(candidate, probe, ambient, gram, products);
    const double gain = lights.misfit - candidate.misfit;
    if (!(gain > 0)) {
      damping *= 8;
      continue;
    }
    lights = std::move(candidate);
    if (gain <= kNegligibleGain * (start - lights.misfit)) break;
    damping = std::max(damping / 8, 1e-9);
    model = modelAround(lights, ambient, gram, products);
  }
}

std::vector<dvec3> irradianceOf(const Constellation& lights, const Rgb& ambient,
                                std::span<const vec3> normals) {
  std::vector<dvec3> irradiance(normals.size(), kPiD * dvec3(ambient));
  for (const DirectionalLight& light : lights)
    for (size_t i = 0; i < normals.size(); ++i)
      irradiance[i] +=
          double(std::fmax(0.0f, dot(normals[i], light.direction))) * dvec3(light.irradiance);
  return irradiance;
}

LightError lightError(std::span<const dvec3> lights, std::span<const dvec3> probe) {
  dvec3 sum(0), max(0), probeSum(0);
  for (size_t i = 0; i < probe.size(); ++i) {
    const dvec3 difference = abs(lights[i] - probe[i]);
    sum += difference;
    max = glm::max(max, difference);
    probeSum += probe[i];
  }
  const auto overRgb = [](const dvec3& v) { return (v.x + v.y + v.z) / 3; };
  const double count = double(probe.size()), mean = overRgb(probeSum) / count;
  const auto percent = [&](double difference) {
    if (mean > 0) return 100 * difference / mean;
    return difference > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  };
  return {percent(overRgb(sum) / count), percent(overRgb(max))};
}

}  // namespace chromeball
