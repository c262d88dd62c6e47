#include "film/aov.h"

#include <algorithm>
#include <cstring>

#include "math/error.h"
#include "math/suggest.h"

namespace chromeball {
namespace {

constexpr float kNoDepth = 1e10f;

}  // namespace

const std::vector<AovInfo>& allAovs() {
  static const std::vector<AovInfo> infos{
      {Aov::Albedo, "albedo", "RGB"},     {Aov::Normal, "normal", "XYZ"},
      {Aov::Depth, "depth", "Z"},         {Aov::Alpha, "alpha", "A"},
      {Aov::Variance, "variance", "RGB"}, {Aov::Samples, "samples", ""},
      {Aov::Material, "material", ""},    {Aov::Node, "node", ""},
      {Aov::WithObjects, "l_obj", "RGB"}, {Aov::WithoutObjects, "l_noobj", "RGB"},
      {Aov::Difference, "difference", "RGB"}, {Aov::Reflectance, "reflectance", "RGB"}};
  return infos;
}

const AovInfo& aovInfo(Aov aov) { return allAovs()[size_t(aov)]; }

Aov aovFromName(const std::string& name, const std::string& place) {
  std::vector<std::string_view> names;
  for (const AovInfo& info : allAovs()) {
    if (name == info.name) return info.aov;
    names.push_back(info.name);
  }
  throwInput("{}: AOV `{}` is not known; {}", place, name, didYouMean(name, names));
}

AovFilm::AovFilm(int width, int height, const std::vector<Aov>& wanted) {
  for (Aov aov : wanted) {
    if (aov == Aov::Variance || aov == Aov::Samples || isOfComposite(aov)) continue;
    const int channels = std::max<int>(1, int(std::strlen(aovInfo(aov).channels)));
    sums_.push_back({aov, Image(width, height, channels)});
  }
  if (!sums_.empty()) samples_ = hits_ = Image(width, height, 1);
}

void AovFilm::add(int x, int y, const FirstHit& first) {
  *samples_.at(x, y) += 1;
  if (!first.hit) return;
  const bool isFirst = *hits_.at(x, y) == 0;
  *hits_.at(x, y) += 1;
  for (Sum& sum : sums_) {
    float* to = sum.image.at(x, y);
    switch (sum.aov) {
      case Aov::Albedo: sum.image.setRgb(x, y, sum.image.rgb(x, y) + first.albedo); break;
      case Aov::Normal: sum.image.setRgb(x, y, sum.image.rgb(x, y) + first.normal); break;
      case Aov::Depth: *to += first.depth; break;
      case Aov::Material: if (isFirst) *to = float(first.material + 1); break;
      case Aov::Node: if (isFirst) *to = float(first.node + 1); break;
      default: break;  // known otherwise
    }
  }
}

Image AovFilm::finished(Aov aov) const {
  for (const Sum& sum : sums_) {
    if (sum.aov != aov) continue;
    Image image = aov == Aov::Alpha ? hits_ : sum.image;
    if (aov == Aov::Material || aov == Aov::Node) return image;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const float hits = *hits_.at(x, y);
        float* texel = image.at(x, y);
        if (aov == Aov::Depth)
          *texel = hits > 0 ? *texel / hits : kNoDepth;
        else
          for (int c = 0; c < image.channels; ++c)
            texel[c] /= std::max(*samples_.at(x, y), 1.0f);  // a render may stop before any
      }
    return image;
  }
  return {};
}

}  // namespace chromeball
