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

}  // namespace

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
  Rgb c = radiance * std::exp2(transform.exposure);
  for (int i = 0; i < 3; ++i) c[i] = c[i] > 0 ? std::min(c[i], kMaxChannel) : 0.0f;
  return glm::clamp(toned(transform.tone, c), Rgb(0), Rgb(1));
}

}  // namespace chromeball
