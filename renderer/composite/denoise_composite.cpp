// SPDX-License-Identifier: Apache-2.0
#include "composite/denoise_composite.h"

#include "composite/layers.h"

namespace chromeball {
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
// share. A negative estimate that is set to 0 is nearer to the truth by as much. The change of the
// plate has at most the error of the plate or of itself, whichever is larger.
Image errorOf(const std::vector<DenoisedPart>& parts, const Image& differences,
              const Composite& composite, const Image& unclamped, const HalvedImage& alpha,
              const Image& plate) {
  Image error(unclamped.width, unclamped.height, 1);
  for (int y = 0; y < error.height; ++y)
    for (int x = 0; x < error.width; ++x) {
      const Rgb behind = plate.empty() ? Rgb(0) : plate.rgb(x, y);
      const Rgb share = alpha.half.rgb(x, y) * behind;
      const Rgb gain = composite.gain.rgb(x, y);
      const Rgb largest = glm::max(gain * absolute(differences.rgb(x, y)), absolute(behind));
      const Rgb change = glm::min(gain * glm::sqrt(parts[1].squaredError.rgb(x, y)), largest);
      const Rgb standardError =
          glm::sqrt(parts[0].squaredError.rgb(x, y) + share * share + change * change);
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
