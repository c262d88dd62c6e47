// SPDX-License-Identifier: Apache-2.0
#include "image/tonemap.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/text.h"

namespace chromeball {
namespace {

// Channels are clamped to this, so that infinity stays finite; far above every operator's white.
constexpr float kMaxChannel = 1e6f;

Rgb reinhard(const Rgb& c) {
  constexpr float kWhite = 4;
  const float y = luminance(c);
  return c * ((1 + y / (kWhite * kWhite)) / (1 + y));
}

// The matrices convert linear sRGB to the RRT space of the fit and back (glm is column-major).
Rgb aces(const Rgb& c) {
  const mat3 in(0.59719f, 0.07600f, 0.02840f, 0.35458f, 0.90834f, 0.13383f, 0.04823f, 0.01566f,
                0.83777f);
  const mat3 out(1.60475f, -0.10208f, -0.00327f, -0.53108f, 1.10813f, -0.07276f, -0.07367f,
                 -0.00605f, 1.07602f);
  const Rgb v = in * c;
  return out *
         ((v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f));
}

Rgb pbrNeutral(Rgb c) {
  constexpr float kStart = 0.8f - 0.04f, kDesaturation = 0.15f;
  const float minimum = std::min(c.x, std::min(c.y, c.z));
  c -= minimum < 0.08f ? minimum - 6.25f * minimum * minimum : 0.04f;
  const float peak = maxComponent(c);
  if (peak < kStart) return c;
  constexpr float d = 1 - kStart;
  const float newPeak = 1 - d * d / (peak + d - kStart);
  c *= newPeak / peak;
  return glm::mix(c, Rgb(newPeak), 1 - 1 / (kDesaturation * (peak - newPeak) + 1));
}

Rgb filmic(const Rgb& color) {
  const auto curve = [](const Rgb& x) {
    return (x * (0.15f * x + 0.10f * 0.50f) + 0.20f * 0.02f) /
               (x * (0.15f * x + 0.50f) + 0.20f * 0.30f) -
           0.02f / 0.30f;
  };
  return curve(color) / curve(Rgb(11.2f));
}

Rgb toned(ToneOperator tone, const Rgb& c) {
  switch (tone) {
    case ToneOperator::Reinhard:
      return reinhard(c);
    case ToneOperator::Aces:
      return aces(c);
    case ToneOperator::PbrNeutral:
      return pbrNeutral(c);
    case ToneOperator::Filmic:
      return filmic(c);
    default:
      return c;
  }
}

// The colour of a black body, of luminance 1.
Rgb blackBody(double kelvin) {
  const double t = 1e3 / kelvin;
  const double x = kelvin < 4000 ? ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.179910
                                 : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.240390;
  const double y = kelvin < 2222 ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
                   : kelvin < 4000
                       ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
                       : ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
  const glm::dvec3 xyz(x / y, 1, (1 - x - y) / y);
  // XYZ to linear Rec. 709 (glm is column-major).
  const glm::dmat3 toRgb(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259,
                         -0.4985314, 0.0415560, 1.0572252);
  return Rgb(toRgb * xyz);
}

}  // namespace

Rgb balanceOf(const Rgb& light) { return luminance(light) / light; }

Rgb balanceOf(double kelvin) { return balanceOf(blackBody(kelvin) / blackBody(6504)); }

float linearToSrgb(float linear) {
  const float v = std::fabs(linear);
  return std::copysign(v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f,
                       linear);
}

float srgbToLinear(float encoded) {
  const float v = std::fabs(encoded);
  return std::copysign(v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f), encoded);
}

const std::vector<std::string_view>& toneOperatorNames() {
  static const std::vector<std::string_view> names{"none", "reinhard", "aces", "neutral", "filmic"};
  return names;
}

ToneOperator parseToneOperator(std::string_view name) {
  const std::vector<std::string_view>& names = toneOperatorNames();
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throwInput("unknown tone mapping `{}`; {}", name, didYouMean(name, names));
  return ToneOperator(found - names.begin());
}

Rgb display(const DisplayTransform& transform, const Rgb& radiance) {
  Rgb c = radiance * std::exp2(transform.exposure) * transform.balance;
  for (int i = 0; i < 3; ++i) c[i] = c[i] > 0 ? std::min(c[i], kMaxChannel) : 0.0f;
  return glm::clamp(toned(transform.tone, c), Rgb(0), Rgb(1));
}

namespace {

constexpr double kMean = 0.25;
constexpr double kOutliers = 0.02;  // at either end
constexpr double kClipped = 0.05;
constexpr double kDarker = 1.5;  // stops, at most, so that more does not clip
constexpr double kMostClipped = 0.25;

struct Levels {
  std::vector<float> luminances, largest;  // of the pixels, in ascending order
};

Levels levelsOf(const Image& radiance, const Image* coverage) {
  Levels levels;
  for (size_t i = 0; i < radiance.pixels(); ++i) {
    const Rgb c = radiance.channels < 3 ? Rgb(*radiance.at(i)) : radiance.rgb(i);
    const float y = luminance(c);
    if (!(y > 0) || !std::isfinite(y) || (coverage && !(*coverage->at(i) >= 0.5f))) continue;
    levels.luminances.push_back(y);
    levels.largest.push_back(maxComponent(c));
  }
  std::ranges::sort(levels.luminances);
  std::ranges::sort(levels.largest);
  return levels;
}

}  // namespace

float autoExposure(const Image& radiance, const Image& coverage) {
  Levels levels = coverage.empty() ? Levels() : levelsOf(radiance, &coverage);
  if (levels.luminances.empty()) levels = levelsOf(radiance, nullptr);
  if (levels.luminances.empty()) return 0;
  const size_t count = levels.luminances.size(), outliers = size_t(kOutliers * double(count));
  double sum = 0;
  for (size_t i = outliers; i < count - outliers; ++i)
    sum += std::log2(double(levels.luminances[i]));
  const double toMean = std::log2(kMean) - sum / double(count - 2 * outliers);
  const auto whereClips = [&](double fraction) {
    return -std::log2(double(levels.largest[size_t(double(count - 1) * (1 - fraction))]));
  };
  const double dark = std::min(toMean - kDarker, whereClips(kMostClipped));
  const double stops = std::min(toMean, std::max(whereClips(kClipped), dark));
  return float(std::round(10 * stops) / 10) + 0.0f;  // never -0
}

}  // namespace chromeball
