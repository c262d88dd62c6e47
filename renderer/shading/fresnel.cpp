// SPDX-License-Identifier: Apache-2.0
#include "shading/fresnel.h"

namespace chromeball {
namespace {

// Fresnel's reflectance at normal incidence between media of these indices.
float normalFilmReflectance(float a, float b) {
  const float r = (a - b) / (a + b);
  return r * r;
}

// The XYZ of cos(2 pi path / wavelength + shift) over a flat spectrum, as linear Rec. 709: the
// Fourier transform of Gaussians fitted to the CIE's colour matching functions (Belcour and Barla
// 2017, section 4 and supplemental material). `path` in nanometres.
Rgb sensitivity(float path, float shift) {
  const float phase = 2 * kPi * path * 1e-9f;
  const auto peak = [&](float value, float position, float variance) {
    return value * std::sqrt(2 * kPi * variance) * std::cos(position * phase + shift) *
           std::exp(-variance * phase * phase);
  };
  const vec3 xyz =
      vec3(peak(5.4856e-13f, 1.6810e6f, 4.3278e9f) + peak(9.7470e-14f, 2.2399e6f, 4.5282e9f),
           peak(4.4201e-13f, 1.7953e6f, 9.3046e9f), peak(5.2481e-13f, 2.2084e6f, 6.6121e9f)) /
      1.0685e-7f;
  return {3.2404542f * xyz.x - 1.5371385f * xyz.y - 0.4985314f * xyz.z,
          -0.9692660f * xyz.x + 1.8760108f * xyz.y + 0.0415560f * xyz.z,
          0.0556434f * xyz.x - 0.2040259f * xyz.y + 1.0572252f * xyz.z};
}

}  // namespace

Rgb thinFilmReflectance(const Rgb& baseF0, float filmIor, float thickness, float cosine) {
  // The film's index approaches air's as its thickness approaches 0 (KHR_materials_iridescence).
  const float film = glm::mix(1.0f, filmIor, glm::smoothstep(0.0f, 0.03f, thickness));
  const float sin2 = (1 - cosine * cosine) / (film * film);
  if (sin2 >= 1) return Rgb(1);
  const float inside = std::sqrt(1 - sin2);

  const float r12 = fresnelDielectric(cosine, film), passed = 1 - r12;
  const float shift21 = film < 1 ? 0 : kPi;
  const float path = 2 * film * thickness * inside;
  Rgb reflectance;
  for (int c = 0; c < 3; ++c) {
    const float root = std::sqrt(glm::clamp(baseF0[c], 0.0f, 0.9999f));
    const float base = (1 + root) / (1 - root);
    const float r23 = fresnelSchlick(normalFilmReflectance(base, film), 1.0f, inside);
    const float shift = shift21 + (base < film ? kPi : 0);
    const float r123 = glm::clamp(r12 * r23, 0.0f, 0.9999f);
    const float rs = passed * passed * r23 / (1 - r123);
    float sum = r12 + rs, order = rs - passed;
    for (int m = 1; m <= 2; ++m) {
      order *= std::sqrt(r123);
      sum += order * 2 * sensitivity(float(m) * path, float(m) * shift)[c];
    }
    reflectance[c] = glm::clamp(sum, 0.0f, 1.0f);
  }
  return reflectance;
}

Rgb thinFilmF0(const Rgb& baseF0, float filmIor, float thickness, float cosine) {
  const float c = 1 - cosine, grazing = std::min(c * c * c * c * c, 0.9999f);
  const Rgb reflectance = thinFilmReflectance(baseF0, filmIor, thickness, cosine);
  return glm::clamp((reflectance - grazing) / (1 - grazing), 0.0f, 1.0f);
}

}  // namespace chromeball
