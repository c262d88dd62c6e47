// SPDX-License-Identifier: Apache-2.0
// Vectors, colours and shared constants. Colours are linear Rec. 709 throughout.
//
// Use std::max and std::min: fmax and fmin are function calls without -ffast-math.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace chromeball {

using glm::mat3;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using Rgb = glm::vec3;  // linear Rec. 709, D65

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 1 / kPi;
inline constexpr double kPiD = 3.14159265358979323846;

// Arithmetic from one source for one number and for several at once: functions take F, a float or a
// vector of lanes (math/lanes.h).
template <class F>
struct LanesOf;
template <>
struct LanesOf<float> {
  using Int = int;
  static constexpr int kCount = 1;

  static float splat(float x) { return x; }  // the same number in each lane
  static float squareRoot(float x) { return std::sqrt(x); }
  static float magnitude(float x) { return std::fabs(x); }
  static float floor(float x) { return std::floor(x); }
  static float nearest(float x) { return std::nearbyint(x); }
  static int toInt(float x) { return int(x); }  // rounded towards 0
  static float toFloat(int x) { return float(x); }
  static bool isNegative(float x) { return std::signbit(x); }  // a condition for ?:
  static float withSignOf(float x, float sign) { return std::copysign(x, sign); }
  static float gather(const float* p, int index) { return p[index]; }
};
template <class F>
using IntOf = typename LanesOf<F>::Int;

// As std::min and std::max, also for NaN: the first argument, unless the second one compares below
// or above it.
template <class F>
F smaller(F a, F b) {
  return b < a ? b : a;
}
template <class F>
F larger(F a, F b) {
  return a < b ? b : a;
}

// A vector, or a colour, in each lane.
template <class F>
struct Lanes3 {
  F x, y, z;
};

template <class F>
Lanes3<F> operator+(const Lanes3<F>& a, const Lanes3<F>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
Lanes3<F> operator-(const Lanes3<F>& a, const Lanes3<F>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
Lanes3<F> operator*(const Lanes3<F>& a, const Lanes3<F>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class F>
Lanes3<F> operator*(F factor, const Lanes3<F>& v) {
  return {factor * v.x, factor * v.y, factor * v.z};
}
template <class F>
F dot(const Lanes3<F>& a, const Lanes3<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
Lanes3<F> cross(const Lanes3<F>& a, const Lanes3<F>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F>
Lanes3<F> normalized(const Lanes3<F>& v) {
  return (1 / LanesOf<F>::squareRoot(dot(v, v))) * v;
}
// For each lane, as condition ? a : b.
template <class Condition, class F>
Lanes3<F> chosen(const Condition& condition, const Lanes3<F>& a, const Lanes3<F>& b) {
  return {condition ? a.x : b.x, condition ? a.y : b.y, condition ? a.z : b.z};
}

inline Lanes3<float> lanesOf(const vec3& v) { return {v.x, v.y, v.z}; }
inline vec3 vectorOf(const Lanes3<float>& v) { return {v.x, v.y, v.z}; }

inline float luminance(const Rgb& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline double luminance(const glm::dvec3& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }
template <class F>
F luminance(const Lanes3<F>& c) {
  return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}
inline float maxComponent(const Rgb& c) { return std::max(c.x, std::max(c.y, c.z)); }
inline double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }
// glm::abs branches on the sign of each component.
inline vec3 absolute(const vec3& v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }
inline bool isBlack(const Rgb& c) { return c.x == 0 && c.y == 0 && c.z == 0; }
inline bool isFinite(const Rgb& c) {
  return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

// An orthonormal basis around a normal.

// Columns x, y, z of the rotation that takes local +z to the normal (Duff et al. 2017, "Building an
// Orthonormal Basis, Revisited").
struct Frame {
  vec3 x, y, z;

  explicit Frame(const vec3& normal) : z(normal) {
    const float sign = std::copysign(1.0f, z.z);
    const float a = -1 / (sign + z.z), b = z.x * z.y * a;
    x = {1 + sign * z.x * z.x * a, sign * b, -sign * z.x};
    y = {b, sign + z.y * z.y * a, -z.y};
  }

  // A frame with local +x along the component of the tangent that is perpendicular to the normal;
  // any x if there is none.
  Frame(const vec3& normal, const vec3& tangent) : Frame(normal) {
    const vec3 along = tangent - normal * glm::dot(normal, tangent);
    const float length2 = glm::dot(along, along);
    if (!(length2 > 1e-12f)) return;
    x = along / std::sqrt(length2);
    y = glm::cross(z, x);
  }

  vec3 toLocal(const vec3& v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
  vec3 toWorld(const vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};

// Directions of vectors whose squared length may exceed the range of a double.

// The direction of a finite vector; 0 for 0.
inline glm::dvec3 unitOrZero(const glm::dvec3& v) {
  const double longest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  return longest > 0 ? glm::normalize(v / longest) : glm::dvec3(0);
}

// The power of two nearest to a positive number, by ratio, between 2^-120 and 2^120: floats scaled
// by it or by its inverse are not rounded. 1 for numbers that are not positive.
inline float powerOfTwoNear(double number) {
  constexpr double kMostOctaves = 120;
  if (!(number > 0)) return 1;
  const double octaves = std::round(std::log2(number));
  return float(std::exp2(std::clamp(octaves, -kMostOctaves, kMostOctaves)));
}

// Trigonometry by polynomials, for angles in turns (1 = 360 degrees). The C library's functions
// took more than a tenth of a render's time. The error of atan2 is below 5e-8 turns (a texel of a
// 16k probe is 6e-5). NaN propagates.

// Sine and cosine of an angle in turns; absolute error below 2e-7 for |turns| <= 1.
template <class F>
void sinCosTurns(F turns, F& sine, F& cosine) {
  const F quadrant = LanesOf<F>::nearest(4 * turns);
  const F r = turns - 0.25f * quadrant;  // exact, in [-1/8, 1/8]
  const F s = r * r;
  const F sinR = r * (6.28318529f + s * (-41.3416626f + s * (81.5925429f + s * -75.4016127f)));
  const F cosR = 1 + s * (-19.7392087f + s * (64.9393161f + s * (-85.4428446f + s * 59.2201690f)));
  const IntOf<F> q = LanesOf<F>::toInt(quadrant);
  const F a = (q & 1) != 0 ? cosR : sinR, b = (q & 1) != 0 ? sinR : cosR;
  sine = (q & 2) != 0 ? -a : a;
  cosine = ((q + 1) & 2) != 0 ? -b : b;
}

// atan2(y, x) in turns, [-1/2, 1/2]; 0 for (0, 0).
template <class F>
F atan2Turns(F y, F x) {
  const F ax = LanesOf<F>::magnitude(x), ay = LanesOf<F>::magnitude(y);
  const F high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
  const F q = high > 0 ? low / high : high;
  const F s = q * q;
  F turns =
      q *
      (0.159154924f +
       s * (-0.0530492275f +
            s * (0.0317784067f +
                 s * (-0.0222869285f +
                      s * (0.0157067872f +
                           s * (-0.00936304601f + s * (0.00378478708f + s * -0.000725713434f)))))));
  turns = ay > ax ? 0.25f - turns : turns;
  turns = LanesOf<F>::isNegative(x) ? 0.5f - turns : turns;
  return LanesOf<F>::withSignOf(turns, y);
}

// What rounding to float takes from a vector.

// v - vec3(v). GCC 12 takes it for 0 where it vectorizes, which the volatile number prevents.
inline glm::dvec3 floatRest(const glm::dvec3& v) {
  glm::dvec3 rest;
  for (int k = 0; k < 3; ++k) {
    const volatile float rounded = float(v[k]);
    rest[k] = v[k] - double(rounded);
  }
  return rest;
}

}  // namespace chromeball
