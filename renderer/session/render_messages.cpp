// SPDX-License-Identifier: Apache-2.0
#include "session/render_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/file.h"
#include "description/capabilities.h"
#include "render/guide_training.h"

namespace chromeball {
namespace {

// The exposure to try if most pixels of a .png are clipped.
std::optional<std::string> whyWhite(const LoadedScene& loaded, const RenderResult& result,
                                    const SettingWords& words) {
  const RenderDescription& description = loaded.description;
  const bool hasPng = std::any_of(description.output.files.begin(), description.output.files.end(),
                                  [](const auto& path) { return lowerExtension(path) == ".png"; });
  if (!hasPng) return std::nullopt;
  const Image mean = result.film.mean();
  std::vector<float> brightest;
  size_t clipped = 0;
  for (int y = 0; y < mean.height; ++y)
    for (int x = 0; x < mean.width; ++x) {
      brightest.push_back(maxComponent(mean.rgb(x, y)));
      clipped += maxComponent(display(description.output.display, mean.rgb(x, y))) >= 1;
    }
  if (2 * clipped <= brightest.size()) return std::nullopt;
  const auto high = brightest.begin() + std::ptrdiff_t(brightest.size() * 9 / 10);
  std::nth_element(brightest.begin(), high, brightest.end());
  std::string hint =
      fmt::format("{:.0f}% of the .png's pixels are clipped; try {}",
                  100 * double(clipped) / double(brightest.size()),
                  words("output.exposure", fmt::format("{:.0f}", std::floor(-std::log2(*high)))));
  if (!loaded.scene.lights.empty())
    hint += ", or dim the model's lights with " + words("lighting.lights", "FACTOR");
  return hint;
}

bool isOfDirect(DepthLimit limit, const RenderSettings& settings) {
  return limit == DepthLimit::Depth && settings.integrator == IntegratorKind::Direct &&
         settings.maxDepth > 0;
}

void addDepthCuts(const RenderSettings& settings, const DepthCut& cut, const SettingWords& words,
                  Messages& messages) {
  constexpr double kMinFraction = 0.01;
  for (size_t i = 0; i < DepthCut::kLimits; ++i) {
    const DepthLimit limit = DepthLimit(i);
    const double fraction = cut.fraction(limit);
    if (!(fraction > kMinFraction)) continue;
    const std::string path = words("render.integrator", "path");
    const std::string remedy = !isOfDirect(limit, settings) ? "a higher one"
                               : settings.maxDepth > 1
                                   ? path
                                   : path + " with a higher " + words("render.max_depth", {});
    addWarning(messages, "{} cut about {:.3g}% of the light; {} keeps it",
               limitInWords(limit, settings, words), 100 * fraction, remedy);
  }
}

// Where the samples or the time ended the render before the noise was as low as was asked for. Two
// passes have a message of their own.
void addNoiseLimit(const RenderDescription& description, const FinishedRender& result,
                   Messages& messages) {
  const RenderSettings& settings = description.settings;
  const bool hasTwoPasses = description.composite && description.composite->passes == Passes::Two;
  if (!settings.noiseLimit || hasTwoPasses || result.render.interrupted ||
      !(result.noise.noise > *settings.noiseLimit))
    return;
  const bool byTime = settings.timeLimit && result.render.samples < settings.samples;
  addNote(
      messages, "{}: the noise is {:.3g}%, not {:g}%: the {} ended the render before",
      namedOrigin(description, "render.noise"), 100 * result.noise.noise,
      100 * *settings.noiseLimit,
      byTime ? "limit of time" : fmt::format("limit of {} samples per pixel", settings.samples));
  messages.back().remedy = Remedy{byTime ? "render.time" : "render.samples", {}};
}

// `guide = "on"` where a guide could not be learned.
void addGuide(const RenderDescription& description, const RenderResult& result,
              Messages& messages) {
  const RenderSettings& settings = description.settings;
  if (settings.guiding == Guiding::On && GuideTraining::samplesOf(settings) > 0 &&
      !settings.path().limitsKinds() && !result.interrupted && result.guidedRegions == 0 &&
      result.causticFraction == 0)
    addNote(messages,
            "{}: nothing was guided: in the first {} samples per pixel too few rays found light to "
            "learn from, or guiding would not reduce the noise",
            namedOrigin(description, "render.guide"), GuideTraining::samplesOf(settings));
}

}  // namespace

std::string limitInWords(DepthLimit limit, const RenderSettings& settings,
                         const SettingWords& words) {
  if (isOfDirect(limit, settings)) return words("render.integrator", "direct");
  const std::array values = {settings.maxDepth, settings.maxDiffuseDepth, settings.maxSpecularDepth,
                             settings.maxTransmissionDepth};  // as DepthLimit
  return words(fmt::format("render.{}", kDepthLimitNames[size_t(limit)]),
               std::to_string(values[size_t(limit)]));
}

void addExcluded(const RenderResult& result, const SettingWords& words, Messages& messages) {
  const auto warning = [&](std::string text) {
    messages.push_back({Message::Kind::Warning, std::move(text)});
  };
  if (const InvalidSamples& invalid = result.invalid; invalid.total())
    warning(fmt::format(
        "{} invalid samples were left out ({} with a NaN, {} infinite, {} negative), "
        "the first at pixel ({}, {}); {} shows where",
        invalid.total(), invalid.of(Defect::Nan), invalid.of(Defect::Infinite),
        invalid.of(Defect::Negative), invalid.x, invalid.y, words("output.aovs", "invalid")));
  const bool isComposite = !result.layers.empty() && result.groups.empty();
  if (result.clamped.count)
    warning(fmt::format("{} scaled {} samples down, and removed {:.3g}% of the light of {}",
                        words("clamp", {}), result.clamped.count,
                        100 * result.clamped.fractionRemoved(),
                        isComposite ? "objects and differences" : "the image"));
}

Messages resultMessages(const LoadedScene& loaded, const PreparedScene& prepared,
                        const FinishedRender& result, const SettingWords& words) {
  const RenderDescription& description = loaded.description;
  Messages messages;
  addExcluded(result.render, words, messages);
  addDepthCuts(description.settings, result.render.depthCut, words, messages);
  messages.insert(messages.end(), result.messages.begin(), result.messages.end());
  const RenderSettings& settings = description.settings;
  if (settings.clamp && result.render.clamped.count == 0)
    addNote(messages, "{}: no sample was above {:g}", namedOrigin(description, "clamp"),
            *settings.clamp);
  if (!settings.isPart()) {
    addNoiseLimit(description, result, messages);
    addGuide(description, result.render, messages);
  }
  if (description.composite || description.settings.isPart()) return messages;
  if (!result.render.interrupted)
    if (const auto why = whyBlack(loaded, prepared.world->accel, result.render, words))
      messages.push_back({Message::Kind::Warning, *why});
  if (const auto why = whyWhite(loaded, result.render, words))
    messages.push_back({Message::Kind::Note, *why});
  return messages;
}

}  // namespace chromeball
