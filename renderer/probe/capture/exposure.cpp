// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/exposure.h"

#include <algorithm>
#include <map>

#include "base/error.h"

namespace chromeball {
namespace {

// The transmissions of the apertures in use, relative to f/1.
class Transmissions {
 public:
  explicit Transmissions(std::span<const CameraSettings> photographs) {
    for (const CameraSettings& photograph : photographs)
      if (photograph.aperture && !find(*photograph.aperture))
        entries_.push_back({*photograph.aperture, std::pow(*photograph.aperture, -2)});
  }

  double of(double aperture) const {
    return std::ranges::find_if(
               entries_,
               [&](const Entry& entry) { return isSameAperture(entry.aperture, aperture); })
        ->transmission;
  }

  void apply(const ApertureRatio& ratio) {
    Entry *from = find(ratio.from), *to = find(ratio.to);
    for (const auto& [entry, number] : {std::pair{from, ratio.from}, {to, ratio.to}})
      if (!entry) throwInput("--aperture-ratio: no photograph was taken at f/{:g}", number);
    if (to->isUsed || from == to)
      throwInput(
          "--aperture-ratio: {:g}:{:g} changes f/{:g}, which another ratio has used; give the "
          "ratios in a row, as in 4:8=4.1 8:16=4.2",
          ratio.from, ratio.to, ratio.to);
    to->transmission = from->transmission / ratio.ratio;
    from->isUsed = to->isUsed = true;
  }

 private:
  struct Entry {
    double aperture, transmission;
    bool isUsed = false;
  };

  Entry* find(double aperture) {
    const auto found = std::ranges::find_if(
        entries_, [&](const Entry& entry) { return isSameAperture(entry.aperture, aperture); });
    return found == entries_.end() ? nullptr : &*found;
  }

  std::vector<Entry> entries_;
};

}  // namespace

std::vector<double> exposureFactors(std::span<const CameraSettings> photographs,
                                    std::span<const ApertureRatio> ratios) {
  Transmissions transmissions(photographs);
  for (const ApertureRatio& ratio : ratios) transmissions.apply(ratio);
  std::vector<double> factors;
  for (const CameraSettings& p : photographs)
    factors.push_back(p.time * p.iso.value_or(100) / 100 *
                      (p.aperture ? transmissions.of(*p.aperture) : 1));
  return factors;
}

int sampleStep(const Image& image) {
  constexpr double kSamples = 1 << 20;
  return std::max(1, int(std::sqrt(double(image.width) * image.height / kSamples)));
}

}  // namespace chromeball
