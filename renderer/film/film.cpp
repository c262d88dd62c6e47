#include "film/film.h"

#include <algorithm>
#include <cmath>

namespace chromeball {
namespace {

constexpr int kReach = 3;  // the two measures of error are compared over 7 x 7 pixels

// Adds to each entry its neighbours within kReach along an axis: `step` apart, `length` in a line.
void boxSum(std::vector<glm::dvec4>& field, size_t first, size_t step, int length) {
  std::vector<glm::dvec4> line(static_cast<size_t>(length));
  for (int i = 0; i < length; ++i) line[size_t(i)] = field[first + size_t(i) * step];
  for (int i = 0; i < length; ++i) {
    glm::dvec4 sum(0);
    for (int j = std::max(0, i - kReach); j <= std::min(length - 1, i + kReach); ++j)
      sum += line[size_t(j)];
    field[first + size_t(i) * step] = sum;
  }
}

void boxSum(std::vector<glm::dvec4>& field, int width, int height) {
  for (int y = 0; y < height; ++y) boxSum(field, size_t(y) * width, 1, width);
  for (int x = 0; x < width; ++x) boxSum(field, size_t(x), size_t(width), height);
}

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
  // Both estimate the variance of a sample: `among` blocks as they really scatter, `within` blocks
  // as if samples were independent. A pixel weighs as much as it adds to the noise, by the root of
  // its variance, lest one firefly speak for all.
  std::vector<glm::dvec4> among(pixels_.size(), glm::dvec4(0)), within = among;
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& p = pixels_[i];
    if (p.blocks < 2) continue;
    within[i] = glm::sqrt(p.sampleVariance());
    for (int c = 0; c < 4; ++c)
      if (within[i][c] > 0) among[i][c] = p.blockScatter[c] / (p.blocks - 1) / within[i][c];
  }
  boxSum(among, width_, height_);
  boxSum(within, width_, height_);

  std::vector<glm::dvec4> errors(pixels_.size(), glm::dvec4(std::nan("")));
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const Pixel& p = pixels_[i];
    if (p.blocks < 2) continue;
    glm::dvec4 ratio(1);
    for (int c = 0; c < 4; ++c)
      if (within[i][c] > 0) ratio[c] = among[i][c] / within[i][c];
    errors[i] = ratio * p.sampleVariance() / double(p.count);
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
