// SPDX-License-Identifier: Apache-2.0
#include "session/finish.h"

#include <algorithm>
#include <map>

#include "composite/compose.h"
#include "composite/layers.h"
#include "film/rows.h"
#include "relight/stage/light_layers.h"

namespace chromeball {
namespace {

Image withAlpha(const Image& color, const Image& alpha) {
  Image image(color.width, color.height, 4);
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      image.setRgb(x, y, color.rgb(x, y));
      image.at(x, y)[3] = *alpha.at(x, y);
    }
  return image;
}

// The layers that `chromeball image denoise` reads.
void addFeatures(const RenderResult& result, OutputImage& output) {
  const auto add = [&](const std::string& name, const char* channels, HalvedImage image) {
    output.layers.push_back({"denoise." + name, channels, std::move(image.mean)});
    output.layers.push_back({"denoise." + name + "_half", channels, std::move(image.half)});
  };
  output.layers.push_back({"denoise.half", "RGB", result.film.halfDifference()});
  add("direct", "RGB", result.features.direct());
  add("albedo", "RGB", result.features.albedo());
  add("normal", "XYZ", result.features.normal());
  add("disparity", "Y", result.features.disparity());
}

Layer layerOf(Aov aov, const RenderResult& result, const Image& variance) {
  const AovInfo& info = aovInfo(aov);
  return {info.name, info.channels,
          aov == Aov::Variance  ? variance
          : aov == Aov::Samples ? result.film.sampleCounts()
                                : result.aovs.finished(aov)};
}

// The radiance of a group.
Image groupImage(const LayerFilm& film, int group) {
  Image image(film.width(), film.height(), 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      image.setRgb(x, y, Rgb(film.value(x, y, group) / std::max<double>(film.count(x, y), 1)));
  return image;
}

// light.NAME: the radiance of a group. shadow.NAME: the factor by which the picture darkens where
// the group's light is blocked, (L - L_group) / L, from 0 to 1; 1 where the picture is black. The
// color becomes the sum of the layers, in the order in which an .exr has them.
void addGroups(const FinishPlan& plan, const RenderResult& result, OutputImage& output) {
  std::map<std::string, int> order;
  for (size_t i = 0; i < plan.groups.size(); ++i) order[plan.groups[i]] = int(i);
  std::vector<Image> images;
  for (const auto& [name, group] : order) images.push_back(groupImage(result.layers, group));
  Image& color = output.layers.front().image;
  const Image sum = sumOf(images);
  for (int y = 0; y < sum.height; ++y)
    for (int x = 0; x < sum.width; ++x) color.setRgb(x, y, sum.rgb(x, y));
  size_t i = 0;
  for (const auto& [name, group] : order) {
    Image& image = images[i++];
    if (plan.settings.shadowMattes)
      output.layers.push_back({"shadow." + name, "RGB", shadowMatte(sum, image)});
    if (plan.settings.lightGroups)
      output.layers.push_back({"light." + name, "RGB", std::move(image)});
  }
}

OutputImage assemble(const RenderResult& result, const FinishPlan& plan, const Image& variance) {
  const RenderSettings& settings = plan.settings;
  OutputImage output;
  if (settings.hideProbe)
    output.layers.push_back(
        {"", "RGBA", withAlpha(result.film.mean(), result.aovs.finished(Aov::Alpha))});
  else
    output.layers.push_back({"", "RGB", result.film.mean()});
  for (const Aov aov : settings.aovs)
    if (aov == Aov::Denoise)
      addFeatures(result, output);
    else
      output.layers.push_back(layerOf(aov, result, variance));
  if (!plan.groups.empty()) addGroups(plan, result, output);
  return output;
}

Layer compositeLayerOf(const std::string& name, const CompositeFinish& plan,
                       const RenderResult& result, const Image& variance) {
  const CompositeLayerInfo* own = findCompositeLayer(name);
  if (!own) return layerOf(aovFromName(name, "output.aovs"), result, variance);
  return {own->name, own->channels,
          own->layer == CompositeLayer::Reflectance
              ? plan.reflectance
              : compositeLayer(DifferentialFilm(result.layers), own->layer)};
}

double meanAlpha(const DifferentialFilm& film) {
  double covered = 0, count = 0;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const DifferentialPixel pixel = film.at(x, y);
      covered += pixel.covered, count += pixel.count;
    }
  return covered / std::max(count, 1.0);
}

std::optional<Placement> placementOf(const RenderSettings& s) {
  if (!s.crop) return {};
  return Placement{s.crop->x, s.crop->y, s.width, s.height};
}

// An interrupted render may have too few samples.
bool canBeDenoised(const FinishPlan& plan, const RenderResult& result) {
  return plan.settings.denoisesAtEnd() && result.samples >= 2;
}

// The composite by the difference formula, with its errors.
struct Difference {
  Image mean;
  PixelErrors errors;
};

std::vector<Layer> compositeLayers(const CompositeFinish& composite, const Image& color,
                                   const RenderResult& result, const Image& variance) {
  std::vector<Layer> layers{{"", composite.isShadowCatcher() ? "RGBA" : "RGB", color}};
  for (const std::string& name : composite.layers)
    layers.push_back(compositeLayerOf(name, composite, result, variance));
  return layers;
}

FinishedImage finishComposite(const FinishPlan& plan, const RenderResult& result,
                              Difference difference, const Progress& progress,
                              const std::atomic<bool>& stop) {
  const CompositeFinish& composite = *plan.composite;
  const DifferentialFilm film(result.layers);
  const Composite composed = compose(film, difference.mean, composite.plate, composite.mode);
  FinishedImage finished{
      {},
      ImageNoise(composite.isShadowCatcher()
                     ? std::move(difference.errors)
                     : compositeErrors(film, composed, std::move(difference.errors))),
      {},
      {}};
  finished.composite.emplace();
  finished.composite->coverage = meanAlpha(film);
  finished.composite->darkerThanBlack = composed.darkerThanBlack;
  finished.image.placement = placementOf(plan.settings);
  finished.image.layers =
      compositeLayers(composite, composed.color, result, finished.noise.variance);
  if (canBeDenoised(plan, result))
    finished.denoised = addDenoised(
        [&](const Progress& part) {
          return denoiseComposite(result, composite.plate, composite.mode, part, stop);
        },
        finished.noise, progress, finished.image);
  return finished;
}

template <class T>
void archiveOptional(Archive& a, std::optional<T>& value) {
  bool has = value.has_value();
  a(has);
  if (has && !value) value.emplace();
}

// The pixels follow in archivePixels().
void archiveChannels(Archive& a, Image& image) {
  uint32_t channels = image.empty() ? 0 : uint32_t(image.channels);
  a(channels);
  a.check(channels <= 4);
  if (a.reads()) image = Image(), image.channels = int(channels);
}

void archivePixels(Archive& a, const Crop& window, Image& image) {
  if (a.reads() ? image.channels == 0 : image.empty()) return;
  if (a.reads()) image = Image(window.width, window.height, image.channels);
  const Bands bands{image.width, image.height};
  a.blocks(bands.count(), [&](Archive& block, size_t band) {
    block.items(bands.rows(band).of(image.texels, size_t(image.width * image.channels)));
  });
}

}  // namespace

std::vector<Accumulation> FinishPlan::layers() const {
  if (composite) return DifferentialFilm::layers();
  return std::vector<Accumulation>(groups.size(), Accumulation::Sum);
}

void FinishPlan::archive(Archive& a) {
  RenderSettings& s = settings;
  a(s.width), a(s.height), a(s.samples), a(s.hideProbe), a(s.denoise);
  s.shard.archive(a);
  archiveOptional(a, s.crop);
  if (s.crop) a(*s.crop);
  std::vector<uint32_t> aovs;
  for (const Aov aov : s.aovs) aovs.push_back(uint32_t(aov));
  a(aovs);
  s.aovs.clear();
  for (const uint32_t aov : aovs) {
    a.check(aov < allAovs().size());
    s.aovs.push_back(Aov(aov));
  }
  a(s.lightGroups), a(s.shadowMattes);
  a(groups);
  archiveOptional(a, composite);
  a.check(groups.empty() || !composite);
  a.check(composite || !s.hideProbe || std::ranges::count(s.aovs, Aov::Alpha) > 0);
  if (!composite) return;
  a.enumerator(composite->mode, CompositeMode::ShadowCatcher);
  a(composite->layers);
  archiveChannels(a, composite->plate);
  archiveChannels(a, composite->reflectance);
  a.check(composite->plate.channels == (composite->isShadowCatcher() ? 0 : 3) &&
          composite->reflectance.channels % 3 == 0 &&
          std::ranges::all_of(composite->layers,
                              [&](const std::string& name) { return hasLayer(name); }));
}

bool FinishPlan::hasLayer(const std::string& name) const {
  if (const CompositeLayerInfo* own = findCompositeLayer(name))
    return own->layer != CompositeLayer::Reflectance || composite->reflectance.channels == 3;
  return std::ranges::any_of(allAovs(), [&](const AovInfo& info) {
    return info.name == name &&
           (info.aov == Aov::Variance || info.aov == Aov::Samples ||
            (info.aov != Aov::Denoise && std::ranges::count(settings.aovs, info.aov) > 0));
  });
}

void FinishPlan::archiveImages(Archive& a) {
  if (!composite) return;
  archivePixels(a, settings.window(), composite->plate);
  archivePixels(a, settings.window(), composite->reflectance);
}

FinishedImage finish(const FinishPlan& plan, const RenderResult& result, const Progress& progress,
                     const std::atomic<bool>& stop) {
  if (plan.composite)
    return finishComposite(plan, result, {result.film.mean(), result.film.errors()}, progress,
                           stop);
  FinishedImage finished{{}, ImageNoise(result.film.errors()), {}, {}};
  finished.image = assemble(result, plan, finished.noise.variance);
  finished.image.placement = placementOf(plan.settings);
  if (canBeDenoised(plan, result))
    finished.denoised =
        addDenoised([&](const Progress& part) { return denoiseRender(result, part, stop); },
                    finished.noise, progress, finished.image);
  if (canBeDenoised(plan, result) && !finished.denoised && !plan.settings.wantsAov(Aov::Denoise))
    addFeatures(result, finished.image);  // so that it can be denoised later
  return finished;
}

OutputImage imageOf(const FinishPlan& plan, const RenderResult& result) {
  OutputImage image;
  if (const auto& composite = plan.composite)
    image.layers = compositeLayers(*composite,
                                   compose(DifferentialFilm(result.layers), result.film.mean(),
                                           composite->plate, composite->mode)
                                       .color,
                                   result, {});
  else
    image = assemble(result, plan, {});
  image.placement = placementOf(plan.settings);
  std::erase_if(image.layers, [](const Layer& layer) { return layer.image.empty(); });
  return image;
}

FinishedImage finishComposite(const FinishPlan& plan, const CompositeRender& render,
                              const Progress& progress, const std::atomic<bool>& stop) {
  return finishComposite(plan, render.result, {render.mean, render.errors}, progress, stop);
}

}  // namespace chromeball
