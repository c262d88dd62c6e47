// SPDX-License-Identifier: Apache-2.0
// Clustered principal components against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "relight/transfer/clustered_pca.h"

namespace chromeball::clustered_pca_test {
namespace {

double squaredDistance(std::span<const float> a, std::span<const float> b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a[i]) - double(b[i]), 2);
  return sum;
}

Signals randomSignals(size_t length, size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  Signals all{length, std::vector<float>(length * count)};
  for (float& value : all.values) value = normal(random);
  return all;
}

// Signals around two far points, each in a plane of its own.
Signals twoPlanes() {
  Signals signals{20, {}};
  for (unsigned c = 0; c < 2; ++c) {
    const Signals axes = randomSignals(20, 2, c), weights = randomSignals(2, 30, c + 2);
    for (size_t i = 0; i < 30; ++i)
      for (size_t k = 0; k < 20; ++k)
        signals.values.push_back(20 * float(c) + weights[i][0] * axes[0][k] +
                                 weights[i][1] * axes[1][k]);
  }
  return signals;
}

TEST(ClusteredPca, FullRankIsExact) {
  for (const auto& [length, count] : {std::pair(30, 12), std::pair(12, 30)}) {
    const Signals signals = randomSignals(size_t(length), size_t(count), 5);
    EXPECT_LT(clusteredPca(signals, 1, 12).error, 1e-6);
    EXPECT_GT(clusteredPca(signals, 1, 10).error, 1e-2);
    EXPECT_EQ(clusteredPca(signals, 100, 0).error, 0);  // a cluster each
  }
}

// One cluster is the Eckart-Young theorem: the other singular values remain as error.
TEST(ClusteredPca, OneClusterLeavesTheSmallSingularValues) {
  Signals signals{6, std::vector<float>(6 * 12)};  // +-v_i e_i: mean 0
  double all = 0;
  for (size_t i = 0; i < 6; ++i) {
    const float value = float(6 - i);
    signals.values[(2 * i) * 6 + i] = value, signals.values[(2 * i + 1) * 6 + i] = -value;
    all += 2 * std::pow(double(value), 2);
  }
  double rest = all;
  for (int m = 0; m <= 6; ++m) {
    EXPECT_NEAR(clusteredPca(signals, 1, m).error, std::sqrt(std::max(rest, 0.0) / all), 1e-6) << m;
    rest -= 2 * (6 - m) * (6 - m);
  }
}

TEST(ClusteredPca, FindsClusters) {
  const Signals signals = twoPlanes();
  const ClusteredPca two = clusteredPca(signals, 2, 2);
  EXPECT_LT(two.error, 1e-6);
  for (size_t i = 0; i < 60; ++i) EXPECT_EQ(two.clusterOf[i], two.clusterOf[i / 30 * 30]);
  EXPECT_NE(two.clusterOf[0], two.clusterOf[30]);
  EXPECT_GT(clusteredPca(signals, 1, 2).error, 1e-2);
}

// The signal as its cluster approximates it.
std::vector<float> approximated(const ClusteredPca& pca, size_t i) {
  const auto& [mean, vectors] = pca.clusters[size_t(pca.clusterOf[i])];
  std::vector<float> sum = mean;
  for (size_t m = 0; m < pca.weights[i].size(); ++m)
    for (size_t k = 0; k < sum.size(); ++k) sum[k] += pca.weights[i][m] * vectors[m][k];
  return sum;
}

TEST(ClusteredPca, ErrorFallsWithVectorsAndIsThatOfTheSignals) {
  const Signals signals = randomSignals(24, 200, 9);
  const std::vector<float> zero(signals.values.size());
  double before = INFINITY;
  for (int m = 0; m <= 24; m += 4) {
    const ClusteredPca pca = clusteredPca(signals, 4, m);
    EXPECT_LT(pca.error, before) << m;
    before = pca.error;
    double left = 0;
    for (size_t i = 0; i < 200; ++i) left += squaredDistance(approximated(pca, i), signals[i]);
    EXPECT_NEAR(pca.error, std::sqrt(left / squaredDistance(signals.values, zero)), 1e-6);
    for (const auto& [mean, vectors] : pca.clusters)
      for (size_t a = 0; a < vectors.count(); ++a)
        for (size_t b = 0; b <= a; ++b) {
          double product = 0;
          for (size_t k = 0; k < 24; ++k) product += double(vectors[a][k]) * double(vectors[b][k]);
          EXPECT_NEAR(product, a == b, 1e-5) << m;
        }
  }
  EXPECT_LT(before, 1e-5);
}

TEST(ClusteredPca, DegenerateSignals) {
  const Signals zeros{3, std::vector<float>(15)};
  EXPECT_EQ(clusteredPca(zeros, 2, 2).error, 0);
  EXPECT_LT(clusteredPca({3, std::vector<float>(15, 0.1f)}, 2, 2).error, 1e-7);
  EXPECT_EQ(clusteredPca({1, {1}}, 9, 9).error, 0);
  EXPECT_THROW(clusteredPca({3, {}}, 1, 1), std::invalid_argument);
  EXPECT_THROW(clusteredPca(zeros, 0, 1), std::invalid_argument);
  EXPECT_THROW(clusteredPca(zeros, 1, -1), std::invalid_argument);
}

}  // namespace
}  // namespace chromeball::clustered_pca_test
