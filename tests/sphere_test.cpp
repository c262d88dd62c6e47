// SPDX-License-Identifier: Apache-2.0
#include "sphere_test.h"

#include <algorithm>
#include <cmath>

namespace chromeball {

double integrate(const std::function<double(double, double)>& f, double x0, double x1, double y0,
                 double y1, double tolerance, int minimum, int depth) {
  const auto rule = [&](int n) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        sum += f(x0 + (x1 - x0) * (i + 0.5) / n, y0 + (y1 - y0) * (j + 0.5) / n);
    return sum * (x1 - x0) * (y1 - y0) / (n * n);
  };
  const double coarse = depth < minimum ? 0 : rule(3), fine = depth < minimum ? 0 : rule(6);
  if (depth >= minimum && (depth >= 9 || std::fabs(coarse - fine) < tolerance)) return fine;
  const double xm = (x0 + x1) / 2, ym = (y0 + y1) / 2, t = tolerance / 2;
  return integrate(f, x0, xm, y0, ym, t, minimum, depth + 1) +
         integrate(f, xm, x1, y0, ym, t, minimum, depth + 1) +
         integrate(f, x0, xm, ym, y1, t, minimum, depth + 1) +
         integrate(f, xm, x1, ym, y1, t, minimum, depth + 1);
}

SphereTest testDirections(const std::function<std::optional<vec3>(int)>& draw,
                          const std::function<double(const vec3&)>& pdf, int samples,
                          int minHalvings, int heights, int azimuths) {
  const auto bin = [&](const vec3& w) {
    const int i = std::clamp(int((w.z + 1) / 2 * float(heights)), 0, heights - 1);
    const int j = std::clamp(int(azimuthTurns(w) * float(azimuths)), 0, azimuths - 1);
    return i * azimuths + j;
  };
  std::vector<double> observed(heights * azimuths + 1), expected(heights * azimuths + 1);
  for (int i = 0; i < samples; ++i) {
    const std::optional<vec3> w = draw(i);
    ++observed[w ? bin(*w) : heights * azimuths];
  }
  double total = 0;
  for (int i = 0; i < heights; ++i)
    for (int j = 0; j < azimuths; ++j) {
      const double probability = integrate(
          [&](double z, double turns) {
            return 2 * kPiD * pdf(unitVector(float(z), float(turns)));
          },
          -1 + 2.0 * i / heights, -1 + 2.0 * (i + 1) / heights, double(j) / azimuths,
          double(j + 1) / azimuths, 1e-6, minHalvings);
      expected[i * azimuths + j] = probability * samples;
      total += probability;
    }
  expected.back() = std::max(0.0, (1 - total) * samples);
  return {chiSquareTest(observed, expected), total};
}

}  // namespace chromeball
