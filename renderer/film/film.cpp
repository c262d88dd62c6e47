#include "film/film.h"

#include <algorithm>
#include <limits>

namespace chromeball {
namespace {

constexpr int kTile = 16;  // over which the two measures of error are compared

}  // namespace

Film::Film(int width, int height)
    : width_(width), height_(height), pixels_(size_t(width) * height) {}

void Film::addBlock(int x, int y, const SampleSums& block) {
  if (block.count == 0) return;
  Pixel& p = pixels_[size_t(y) * width_ + x];
  const double n = block.count, before = p.count, after = before + n;
  const glm::dvec4 blockMean = block.sum / n;
  p.scatter += glm::vec4(glm::max(block.sumOfSquares - block.sum * blockMean, 0.0));
  // Combines means and scatters of two sets (Chan, Golub and LeVeque 1983).
  const glm::dvec4 delta = blockMean - p.mean;
  p.mean += delta * (n / after);
  p.blockScatter += glm::vec4(delta * delta * (before * n / after));
  p.count += block.count;
  ++p.blocks;
}

Image Film::mean() const {
  Image image(width_, height_, 3);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) image.setRgb(x, y, Rgb(pixel(x, y).mean));
  return image;
}

Image Film::sampleCounts() const {
  Image image(width_, height_, 1);
  for (size_t i = 0; i < pixels_.size(); ++i) image.texels[i] = float(pixels_[i].count);
  return image;
}

std::vector<glm::dvec4> Film::squaredErrors() const {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<glm::dvec4> errors(pixels_.size(), glm::dvec4(nan));
  for (int top = 0; top < height_; top += kTile)
    for (int left = 0; left < width_; left += kTile) {
      const int bottom = std::min(top + kTile, height_), right = std::min(left + kTile, width_);
      // Both estimate the variance of a sample: `among` blocks as they really scatter, `within`
      // blocks as if samples were independent.
      glm::dvec4 among(0), within(0);
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
          const Pixel& p = pixel(x, y);
          if (p.blocks < 2) continue;
          const glm::dvec4 blockScatter(p.blockScatter);
          among += blockScatter / double(p.blocks - 1);
          within += (glm::dvec4(p.scatter) + blockScatter) / double(p.count - 1);
        }
      glm::dvec4 ratio(1);
      for (int c = 0; c < 4; ++c)
        if (within[c] > 0) ratio[c] = among[c] / within[c];
      for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x) {
          const Pixel& p = pixel(x, y);
          if (p.blocks < 2) continue;
          const glm::dvec4 variance =
              glm::dvec4(p.scatter + p.blockScatter) / double(p.count - 1);
          errors[size_t(y) * width_ + x] = ratio * variance / double(p.count);
        }
    }
  return errors;
}

Image Film::squaredStandardError() const {
  Image image(width_, height_, 3);
  const std::vector<glm::dvec4> errors = squaredErrors();
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const Rgb error(errors[size_t(y) * width_ + x]);
      image.setRgb(x, y, isFinite(error) ? error : Rgb(0));
    }
  return image;
}

double Film::noise() const {
  double meanLuminance = 0;
  for (const Pixel& p : pixels_) meanLuminance += p.mean.w;
  meanLuminance /= double(pixels_.size());
  if (!(meanLuminance > 0)) return 0;

  const std::vector<glm::dvec4> errors = squaredErrors();
  double sum = 0;
  for (size_t i = 0; i < pixels_.size(); ++i)
    sum += std::sqrt(errors[i].w) / std::max(pixels_[i].mean.w, 0.01 * meanLuminance);
  return sum / double(pixels_.size());
}

}  // namespace chromeball
