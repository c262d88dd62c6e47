// SPDX-License-Identifier: Apache-2.0
#include "bake/fill_page.h"

#include "base/parallel.h"

namespace chromeball {
namespace {

class PlaceFiller {
 public:
  PlaceFiller(Image& page, std::vector<uint8_t>& isFilled, const AtlasPlace& place)
      : page_(page), isFilled_(isFilled), place_(place) {}

  void fill() {
    std::vector<glm::ivec2> ring;
    for (int y = place_.y; y < place_.y + place_.height; ++y)
      for (int x = place_.x; x < place_.x + place_.width; ++x)
        if (!at(x, y) && touchesLight(x, y)) ring.emplace_back(x, y);
    while (!ring.empty()) {
      for (const glm::ivec2& p : ring) average(p.x, p.y);
      std::vector<glm::ivec2> next;
      for (const glm::ivec2& p : ring) at(p.x, p.y) = kFilled;
      for (const glm::ivec2& p : ring)
        forNeighbours(p.x, p.y, [&](int x, int y) {
          if (at(x, y) != kEmpty) return;
          at(x, y) = kWaiting;
          next.emplace_back(x, y);
        });
      for (const glm::ivec2& p : next) at(p.x, p.y) = kEmpty;
      ring = std::move(next);
    }
    for (int y = place_.y; y < place_.y + place_.height; ++y)
      for (int x = place_.x; x < place_.x + place_.width; ++x) at(x, y) = kFilled;
  }

 private:
  enum : uint8_t { kEmpty = 0, kFilled = 1, kWaiting = 2 };

  uint8_t& at(int x, int y) { return isFilled_[size_t(y) * size_t(page_.width) + size_t(x)]; }

  template <class Visit>
  void forNeighbours(int x, int y, const Visit& visit) {
    for (int ny = std::max(y - 1, place_.y); ny <= std::min(y + 1, place_.y + place_.height - 1);
         ++ny)
      for (int nx = std::max(x - 1, place_.x); nx <= std::min(x + 1, place_.x + place_.width - 1);
           ++nx)
        if (nx != x || ny != y) visit(nx, ny);
  }

  bool touchesLight(int x, int y) {
    bool touches = false;
    forNeighbours(x, y, [&](int nx, int ny) { touches |= at(nx, ny) == kFilled; });
    return touches;
  }

  // Texels of the same ring are not filled yet, so their order does not matter.
  void average(int x, int y) {
    for (int channel = 0; channel < page_.channels; ++channel) {
      float sum = 0;
      int count = 0;
      forNeighbours(x, y, [&](int nx, int ny) {
        if (at(nx, ny) != kFilled) return;
        sum += page_.at(nx, ny)[channel];
        ++count;
      });
      page_.at(x, y)[channel] = sum / float(count);
    }
  }

  Image& page_;
  std::vector<uint8_t>& isFilled_;
  const AtlasPlace& place_;
};

}  // namespace

void fillPage(Image& page, std::vector<uint8_t> isBaked, const Atlas& atlas) {
  std::vector<double> sums(size_t(page.channels));
  double count = 0;
  for (size_t i = 0; i < isBaked.size(); ++i) {
    if (!isBaked[i]) continue;
    for (size_t c = 0; c < sums.size(); ++c) sums[c] += page.texels[i * sums.size() + c];
    ++count;
  }
  parallelFor(size_t(0), atlas.places.size(),
              [&](size_t i) { PlaceFiller(page, isBaked, atlas.places[i]).fill(); });
  for (size_t i = 0; i < isBaked.size() && count > 0; ++i)
    for (size_t c = 0; c < sums.size() && !isBaked[i]; ++c)
      page.texels[i * sums.size() + c] = float(sums[c] / count);
}

}  // namespace chromeball
