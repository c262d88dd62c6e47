// SPDX-License-Identifier: Apache-2.0
// Trigonometry by polynomials, for angles in turns (1 = 360 degrees). The C library's functions
// took more than a tenth of a render's time. The error of atan2 is below 5e-8 turns (a texel of a
// 16k probe is 6e-5). NaN propagates.
#pragma once

#include <cmath>

namespace chromeball {

// Sine and cosine of an angle in turns; absolute error below 2e-7 for |turns| <= 1.
inline void sinCosTurns(float turns, float& sine, float& cosine) {
  const float quadrant = std::nearbyint(4 * turns);
  const float r = turns - 0.25f * quadrant;  // exact, in [-1/8, 1/8]
  const float s = r * r;
  const float sinR = r * (6.28318529f + s * (-41.3416626f + s * (81.5925429f + s * -75.4016127f)));
  const float cosR =
      1 + s * (-19.7392087f + s * (64.9393161f + s * (-85.4428446f + s * 59.2201690f)));
  const int q = int(quadrant);
  const float a = q & 1 ? cosR : sinR, b = q & 1 ? sinR : cosR;
  sine = q & 2 ? -a : a;
  cosine = (q + 1) & 2 ? -b : b;
}

// atan2(y, x) in turns, [-1/2, 1/2]; 0 for (0, 0).
inline float atan2Turns(float y, float x) {
  const float ax = std::fabs(x), ay = std::fabs(y);
  const float high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
  const float q = high > 0 ? low / high : high;
  const float s = q * q;
  float turns =
      q *
      (0.159154924f +
       s * (-0.0530492275f +
            s * (0.0317784067f +
                 s * (-0.0222869285f +
                      s * (0.0157067872f +
                           s * (-0.00936304601f + s * (0.00378478708f + s * -0.000725713434f)))))));
  if (ay > ax) turns = 0.25f - turns;
  if (std::signbit(x)) turns = 0.5f - turns;
  return std::copysign(turns, y);
}

}  // namespace chromeball
