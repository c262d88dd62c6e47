// SPDX-License-Identifier: Apache-2.0
// Synthetic lat-long probes, for tests and for lighting without a photograph.
#pragma once

#include <array>

#include "image/image.h"
#include "probe/mapping.h"

namespace chromeball {

Image constantProbe(const ImageSize& size, const Rgb& radiance);

// Black except for one texel.
Image oneHotProbe(const ImageSize& size, int x, int y, const Rgb& radiance);

// radiance x (1 + slope . D) at each texel's centre; |slope| <= 1 keeps it positive. The mean is
// `radiance`; the irradiance on a plane with unit normal n is pi radiance (1 + 2/3 slope . n).
Image gradientProbe(const ImageSize& size, const Rgb& radiance, const dvec3& slope);

// CIE standard overcast sky (Moon and Spencer 1942): zenith (1 + 2 sin(elevation)) / 3, above a
// Lambertian ground lit by the sky's irradiance, zenith 7 pi / 9.
Image overcastProbe(const ImageSize& size, const Rgb& zenith, double groundAlbedo);

// A photographer's studio: a key light of 30 on the right, a fill of 8 on the left, a rim strip of
// 15 behind and an overhead panel of 10, in a room of 0.02.
Image studioProbe(const ImageSize& size);

// Clear sky and sun (Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight",
// SIGGRAPH 1999): the sky by its appendix A.2, the sun by A.1.

inline constexpr double kSunDiameter = 0.5323;  // degrees, seen from the Earth

struct ClearSky {
  double sunElevation = 45;  // degrees, 0 to 90
  double sunAzimuth = 0;  // degrees, counter-clockwise seen from above, from -Z (the map's centre)
  double turbidity = 3;   // 2 (very clear) to 10 (hazy)
  double groundAlbedo = 0.2;
};

dvec3 sunDirection(const ClearSky& sky);

// Units: a white surface that faces a sun of 100,000 lux has radiance 1, so 1 is 100/pi kcd/m^2,
// and that sun's irradiance is pi.

// Radiance of the sky at a unit direction above the horizon, Rec. 709, without the sun.
class SkyRadiance {
 public:
  explicit SkyRadiance(const ClearSky& sky);
  dvec3 operator()(const dvec3& direction) const;

 private:
  // Luminance and the chromaticities x and y each have a Perez distribution: five coefficients, and
  // the zenith's value divided by the distribution's value there.
  struct Channel {
    std::array<double, 5> perez;
    double scale;
  };
  std::array<Channel, 3> channels_;
  dvec3 sun_;
};

// The sun's irradiance on a surface that faces it: 128,000 lux of white outside the atmosphere,
// attenuated by air (Rayleigh) and haze (Angstrom) at 610, 550 and 465 nm. The paper's ozone, water
// vapour and mixed gases are omitted.
dvec3 sunIrradiance(const ClearSky& sky);

// Adds a disc of constant radiance to a lat-long map. For any resolution, the sum over texels of
// added radiance x solid angle x cosine between `direction` and the texel's centre is `irradiance`.
void addSunDisc(Image& latLong, const dvec3& direction, double diameterDegrees,
                const dvec3& irradiance);

// The sky, the sun, and below the horizon a Lambertian ground lit by both. Throws InputError if
// elevation or turbidity is out of range.
Image clearSkyProbe(const ImageSize& size, const ClearSky& sky, bool withSun = true);

}  // namespace chromeball
