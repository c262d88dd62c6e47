// SPDX-License-Identifier: Apache-2.0
#include "front/develop_text.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/text.h"
#include "front/arguments.h"

namespace chromeball {
namespace {

constexpr size_t kMaxGaussians = 32;
constexpr std::array<std::string_view, 6> kNames = {"clip",  "depth-blur", "motion",
                                                    "bloom", "glare",      "vignette"};

double numberIn(std::string_view text, double min, double max, std::string_view what,
                std::string_view location) {
  const double number = parseNumbers(text, 1, location).front();
  if (!(number >= min && number <= max))
    throwInput("{}: the {} {:g} should be {:g} to {:g}", location, what, number, min, max);
  return number;
}

struct Halves {
  std::string_view before, after;
};

Halves split(std::string_view text, char separator, std::string_view form,
             std::string_view location) {
  const size_t at = text.find(separator);
  if (at == std::string_view::npos) throwInput("{}: `{}` is not {}", location, text, form);
  return {text.substr(0, at), text.substr(at + 1)};
}

std::vector<WeightedGaussian> parseBloom(std::string_view text, std::string_view location) {
  constexpr double kTolerance = 0.01;
  std::vector<WeightedGaussian> mixture;
  double sum = 0;
  for (const std::string_view part : splitAt(text, ',')) {
    const auto [weight, sigma] = split(part, ':', "WEIGHT:SIGMA, as in .75:1,.25:32", location);
    mixture.push_back({numberIn(weight, 0, 1, "weight", location),
                       numberIn(sigma, 0, kMaxSigma, "sigma (pixels)", location)});
    sum += mixture.back().weight;
    if (mixture.size() > kMaxGaussians)
      throwInput("{}: has more than {} Gaussians", location, kMaxGaussians);
  }
  if (std::fabs(sum - 1) > kTolerance)
    throwInput("{}: the weights sum to {:g}; they should sum to 1, to keep the image's energy",
               location, sum);
  for (WeightedGaussian& gaussian : mixture) gaussian.weight /= sum;
  return mixture;
}

Motion parseMotion(std::string_view text, std::string_view location) {
  const auto [length, angle] = split(text, '@', "LENGTH@ANGLE, as in 60@0", location);
  return {numberIn(length, 0, kMaxMotion, "length (pixels)", location),
          numberIn(angle, -360, 360, "angle (degrees)", location)};
}

ThinLens parseLens(std::string_view text, std::string_view location) {
  constexpr double kSmallest = 1e-6, kLargest = 1e6, kLargestAperture = 1e3;
  const auto [focus, aperture] = split(text, ':', "FOCUS:APERTURE, as in 2.5:0.05", location);
  return {numberIn(focus, kSmallest, kLargest, "focus (metres)", location),
          numberIn(aperture, 0, kLargestAperture, "aperture (metres)", location)};
}

float parseClip(std::string_view text, std::string_view location) {
  const double clip = parseNumbers(text, 1, location).front();
  if (!isPositiveFloat(clip)) throwInput("{}: {:g} should be {}", location, clip, kPositiveFloats);
  return float(clip);
}

}  // namespace

void setDevelop(DevelopSettings& settings, std::string_view name, std::string_view text,
                std::string_view location) {
  if (name == "clip") {
    settings.clip = parseClip(text, location);
  } else if (name == "depth-blur") {
    settings.lens = parseLens(text, location);
  } else if (name == "motion") {
    settings.motion = parseMotion(text, location);
  } else if (name == "bloom") {
    settings.bloom = parseBloom(text, location);
  } else if (name == "glare") {
    if (text != "spencer")
      throwInput("{}: `{}` is not known; {}", location, text, didYouMean(text, {"spencer"}));
    settings.glare = true;
  } else {
    assert(name == "vignette");
    settings.vignette = numberIn(text, 0, 1, "strength", location);
  }
}

DevelopSettings parseDevelop(std::string_view text, std::string_view location) {
  constexpr std::string_view kSpaces = " \t\n";
  DevelopSettings settings;
  std::set<std::string_view> names;
  for (size_t begin = text.find_first_not_of(kSpaces); begin != std::string_view::npos;) {
    const size_t end = std::min(text.find_first_of(kSpaces, begin), text.size());
    const auto [name, value] =
        split(text.substr(begin, end - begin), '=',
              "NAME=VALUE, as in vignette=.4 or bloom=.75:1,.25:32", location);
    if (!names.insert(name).second) throwInput("{}: `{}` is there twice", location, name);
    if (std::ranges::find(kNames, name) == kNames.end())
      throwInput("{}: `{}` is not known; {}", location, name,
                 didYouMean(name, {kNames.begin(), kNames.end()}));
    setDevelop(settings, name, value, fmt::format("{}: {}", location, name));
    begin = text.find_first_not_of(kSpaces, end);
  }
  return settings;
}

}  // namespace chromeball
