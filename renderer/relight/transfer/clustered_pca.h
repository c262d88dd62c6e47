// SPDX-License-Identifier: Apache-2.0
// Clustered principal component analysis (Sloan, Hall, Hart and Snyder 2003: "Clustered Principal
// Components for Precomputed Radiance Transfer", section 4).
#pragma once

#include <span>
#include <vector>

namespace chromeball {

// Vectors of one length.
struct Signals {
  size_t length = 0;
  std::vector<float> values;  // signal by signal

  size_t count() const { return length == 0 ? 0 : values.size() / length; }
  std::span<const float> operator[](size_t i) const {
    return std::span(values).subspan(i * length, length);
  }
};

// Each signal is approximately its cluster's mean + sum over m of weight times vector.
struct ClusteredPca {
  struct Cluster {
    std::vector<float> mean;
    Signals vectors;  // orthonormal, largest variance first; at most m
  };
  std::vector<Cluster> clusters;
  std::vector<int> clusterOf;               // by signal
  std::vector<std::vector<float>> weights;  // by signal: as many as its cluster's vectors
  // Root of the sum of squared differences of all signals over the sum of the signals' squares.
  double error = 0;
};

// `signals`: finite. At most as many clusters as signals are made; a cluster has at most as many
// vectors as signals and as the signals' length. Starts from signals far from each other, then
// alternately assigns each signal to the cluster that approximates it best and analyses each
// cluster anew, for up to `rounds` or until nothing moves: the error never grows. The result
// depends only on the arguments. Throws std::invalid_argument unless clusters >= 1, vectors >= 0
// and there is a signal.
ClusteredPca clusteredPca(const Signals& signals, int clusters, int vectors, int rounds = 12);

}  // namespace chromeball
