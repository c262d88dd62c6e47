// SPDX-License-Identifier: Apache-2.0
#include "composite/compose.h"

#include <algorithm>

namespace chromeball {
namespace {

using glm::dvec3;

// Fraction of the image's mean L_noobj below which the ratio is not used.
constexpr double kMinForRatio = 1e-3;

bool isNegative(const Rgb& c) { return c.x < 0 || c.y < 0 || c.z < 0; }

double alphaOf(const DifferentialPixel& p) { return p.count > 0 ? p.covered / p.count : 0; }

// Mean L_noobj of the samples that see no object; 0 if there are none.
dvec3 localRadiance(const DifferentialPixel& p) {
  return p.count > p.covered ? p.local / (p.count - p.covered) : dvec3(0);
}

dvec3 meanLocalRadiance(const DifferentialFilm& film) {
  dvec3 sum(0);
  double weight = 0;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const DifferentialPixel p = film.at(x, y);
      sum += p.local;
      weight += p.count - p.covered;
    }
  return weight > 0 ? sum / weight : sum;
}

// plate / L_noobj where the ratio is used, 1 where the difference is used.
Rgb ratioGain(const Rgb& plate, const dvec3& local, const dvec3& mean) {
  Rgb gain(1);
  for (int c = 0; c < 3; ++c) {
    const double floor = kMinForRatio * mean[c];
    if (!(local[c] > floor)) continue;
    const double fraction = std::min(local[c] / floor - 1, 1.0);
    gain[c] = float(glm::mix(1.0, plate[c] / local[c], fraction));
  }
  return gain;
}

// Premultiplied colour and alpha.
glm::vec4 caught(const DifferentialPixel& p) {
  if (!(p.count > 0)) return glm::vec4(0);
  const dvec3 ratio = p.ratio();
  const double kept = std::clamp(std::min({ratio.x, ratio.y, ratio.z}), 0.0, 1.0);
  const dvec3 color = (p.objects + p.local + p.difference - kept * p.local) / p.count;
  return {glm::max(Rgb(color), Rgb(0)), float(1 - (1 - alphaOf(p)) * kept)};
}

Composite shadowCatcher(const DifferentialFilm& film) {
  Composite result{Image(film.width(), film.height(), 4), Image(film.width(), film.height(), 3)};
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const glm::vec4 pixel = caught(film.at(x, y));
      std::copy_n(&pixel.x, 4, result.color.at(x, y));
      result.gain.setRgb(x, y, Rgb(1));
    }
  return result;
}

}  // namespace

Composite compose(const DifferentialFilm& film, const Image& mean, const Image& plate,
                  CompositeMode mode) {
  if (mode == CompositeMode::ShadowCatcher) return shadowCatcher(film);
  Composite result{Image(film.width(), film.height(), 3), Image(film.width(), film.height(), 3)};
  const dvec3 meanLocal = meanLocalRadiance(film);
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const DifferentialPixel p = film.at(x, y);
      const Rgb behind = plate.rgb(x, y);
      Rgb gain(1), color = behind;  // an interrupted render may have no samples here
      if (p.count > 0 && mode == CompositeMode::Difference) color = mean.rgb(x, y);
      if (p.count > 0 && mode == CompositeMode::Ratio) {
        gain = ratioGain(behind, localRadiance(p), meanLocal);
        color = Rgb((p.objects + dvec3(gain) * p.difference) / p.count +
                    (1 - alphaOf(p)) * dvec3(behind));
      }
      if (isNegative(color) && !isNegative(behind)) {  // negative plate values are kept
        ++result.darkerThanBlack;
        color = glm::max(color, Rgb(0));
      }
      result.color.setRgb(x, y, color);
      result.gain.setRgb(x, y, gain);
    }
  return result;
}

PixelErrors compositeErrors(const DifferentialFilm& film, const Composite& composite,
                            PixelErrors errors) {
  for (size_t i = 0; i < errors.luminances.size(); ++i) {
    const int x = int(i % size_t(film.width())), y = int(i / size_t(film.width()));
    errors.luminances[i] = luminance(dvec3(composite.color.rgb(x, y)));
    const float alpha = float(alphaOf(film.at(x, y)));
    const Rgb gain = alpha + (1 - alpha) * composite.gain.rgb(x, y);
    const glm::dvec4 squared(gain * gain, luminance(gain) * luminance(gain));
    errors.halves[i] *= squared;
    errors.scatter[i] *= squared;
  }
  return errors;
}

namespace {

using Layer = DifferentialFilm::Layer;

// L_obj - L_noobj is not below -L_noobj: the ratio is not negative.
void limitDifference(const Image& local, Image& difference) {
  for (size_t i = 0; i < local.texels.size(); ++i)
    difference.texels[i] = std::max(difference.texels[i], -local.texels[i]);
}

// The composite by the difference formula.
Image differenceOf(const DifferentialFilm& film, const Image& plate) {
  Image image(film.width(), film.height(), 3);
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const DifferentialPixel p = film.at(x, y);
      const double count = std::max(p.count, 1.0);
      image.setRgb(x, y,
                   Rgb((p.objects + p.difference) / count +
                       (1 - p.covered / count) * glm::dvec3(plate.rgb(x, y))));
    }
  return image;
}

// The standard error of luminance. Alpha, which is not filtered, adds the error of the plate's
// share. Setting a negative estimate to 0 brings it nearer to the truth by as much. The change of
// the plate has at most the error of the plate or of itself, whichever is larger.
Image errorOf(const std::vector<DenoisedPart>& parts, const Image& differences,
              const Composite& composite, const Image& unclamped, const HalvedImage& alpha,
              const Image& plate) {
  Image error(unclamped.width, unclamped.height, 1);
  for (int y = 0; y < error.height; ++y)
    for (int x = 0; x < error.width; ++x) {
      const Rgb behind = plate.empty() ? Rgb(0) : plate.rgb(x, y);
      const glm::dvec3 share(alpha.half.rgb(x, y) * behind);
      const Rgb gain = composite.gain.rgb(x, y);
      const Rgb largest = glm::max(gain * absolute(differences.rgb(x, y)), absolute(behind));
      const glm::dvec3 change(glm::min(gain * parts[1].standardError.rgb(x, y), largest));
      const glm::dvec3 objects(parts[0].standardError.rgb(x, y));
      const Rgb standardError(glm::sqrt(objects * objects + share * share + change * change));
      const Rgb raised = composite.color.rgb(x, y) - unclamped.rgb(x, y);
      *error.at(x, y) = luminance(glm::max(standardError - glm::max(raised, 0.0f), 0.0f));
    }
  return error;
}

}  // namespace

std::optional<Denoised> denoiseComposite(const RenderResult& render, const Image& plate,
                                         CompositeMode mode, const Progress& progress,
                                         const std::atomic<bool>& stop) {
  const FeatureFilm& features = render.features;
  std::vector<Layer> layers{DifferentialFilm::kObjects, DifferentialFilm::kDifference};
  if (mode != CompositeMode::Difference) layers.push_back(DifferentialFilm::kLocal);
  const DifferentialFilm noisy(render.layers);
  DenoiseInput input{{}, features.albedo(), features.normal(), features.disparity()};
  for (const Layer layer : layers) input.parts.push_back(noisy.mean(layer));
  const auto parts = denoise(input, progress, stop);
  if (!parts) return std::nullopt;

  std::map<int, Image> means;
  for (size_t i = 0; i < layers.size(); ++i) {
    Image& mean = means[layers[i]] = (*parts)[i].color;
    if (layers[i] != DifferentialFilm::kDifference)  // a regression may predict less than nothing
      for (float& texel : mean.texels) texel = std::max(texel, 0.0f);
  }
  if (mode != CompositeMode::Difference)
    limitDifference(means.at(DifferentialFilm::kLocal), means.at(DifferentialFilm::kDifference));
  const LayerFilm filtered = render.layers.with(means);
  const DifferentialFilm film(filtered);
  const bool hasPlate = mode != CompositeMode::ShadowCatcher;
  const Image difference =
      hasPlate ? differenceOf(film, plate) : compositeLayer(film, CompositeLayer::WithObjects);
  Composite composite = compose(film, difference, plate, mode);
  const Image& unclamped = mode == CompositeMode::Difference ? difference : composite.color;
  Image error = errorOf(*parts, means.at(DifferentialFilm::kDifference), composite, unclamped,
                        noisy.mean(DifferentialFilm::kCoverage), plate);
  return Denoised{std::move(composite.color), std::move(error), hasPlate ? Image() : difference};
}

}  // namespace chromeball
