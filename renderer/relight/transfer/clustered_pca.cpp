// SPDX-License-Identifier: Apache-2.0
#include "relight/transfer/clustered_pca.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "math/dense_solvers.h"

namespace chromeball {
namespace {

using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;
using Eigen::VectorXf;

// The eigenvectors of the smaller of A A^T and A^T A; the others follow by A. Vectors whose
// variance is only rounding are left out.
MatrixXf principalVectors(const MatrixXd& centred, int most) {
  const bool isWide = centred.cols() > centred.rows();
  const MatrixXd product = normalMatrix(isWide ? MatrixXd(centred.transpose()) : centred);
  const SymmetricEigen eigen = eigenOfSymmetric(product);
  const Eigen::Index size = product.rows();
  const double least = 1e-14 * std::max(eigen.values[size - 1], 0.0);
  std::vector<VectorXd> found;
  for (Eigen::Index i = size - 1; i >= 0 && found.size() < size_t(most); --i) {
    if (!(eigen.values[i] > least)) break;
    VectorXd vector = eigen.vectors.col(i);
    if (!isWide) vector = (centred * vector).eval();
    // Orthogonalises against the earlier ones: rounding moves vectors of small variance off.
    for (const VectorXd& other : found) vector -= other.dot(vector) * other;
    found.push_back(vector.normalized());
  }
  MatrixXf vectors(centred.rows(), Eigen::Index(found.size()));
  for (size_t i = 0; i < found.size(); ++i) vectors.col(Eigen::Index(i)) = found[i].cast<float>();
  return vectors;
}

// A cluster's mean and vectors, which are columns.
struct Affine {
  VectorXf mean;
  MatrixXf vectors;
};

Affine analysed(const MatrixXf& signals, const std::vector<Eigen::Index>& members, int vectors) {
  MatrixXd own(signals.rows(), Eigen::Index(members.size()));
  for (size_t i = 0; i < members.size(); ++i)
    own.col(Eigen::Index(i)) = signals.col(members[i]).cast<double>();
  const VectorXd mean = own.rowwise().mean();
  own.colwise() -= mean;
  return {mean.cast<float>(), principalVectors(own, vectors)};
}

// The residual of a signal: its squared distance from the cluster's affine space.
double residual(const Affine& cluster, const Eigen::Ref<const VectorXf>& signal) {
  const VectorXf centred = signal - cluster.mean;
  const VectorXf weights = cluster.vectors.transpose() * centred;
  return double((centred - cluster.vectors * weights).squaredNorm());
}

// Signal 0, then repeatedly the signal that is farthest from the earlier ones.
std::vector<Affine> farApart(const MatrixXf& signals, int count) {
  std::vector<Affine> clusters;
  VectorXf distances = VectorXf::Constant(signals.cols(), INFINITY);
  Eigen::Index next = 0;
  for (int i = 0; i < count; ++i) {
    clusters.push_back({signals.col(next), MatrixXf(signals.rows(), 0)});
    for (Eigen::Index j = 0; j < signals.cols(); ++j)
      distances[j] = std::min(distances[j], (signals.col(j) - signals.col(next)).squaredNorm());
    distances.maxCoeff(&next);
  }
  return clusters;
}

std::vector<float> toVector(const VectorXf& v) { return {v.begin(), v.end()}; }

class Analysis {
 public:
  Analysis(const MatrixXf& signals, int clusters, int vectors)
      : signals_(signals),
        most_(vectors),
        clusters_(farApart(signals, clusters)),
        clusterOf_(size_t(signals.cols())) {
    assign();
  }

  // Assigns each signal to the best cluster; on a tie it stays. Returns whether one moved.
  bool assign() {
    bool moves = false;
    for (Eigen::Index i = 0; i < signals_.cols(); ++i) {
      int& own = clusterOf_[size_t(i)];
      double least = residual(clusters_[size_t(own)], signals_.col(i));
      for (size_t c = 0; c < clusters_.size(); ++c)
        if (const double left = residual(clusters_[c], signals_.col(i)); left < least) {
          least = left;
          own = int(c);
          moves = true;
        }
    }
    return moves;
  }

  // A cluster without signals stays as it is.
  void analyse() {
    std::vector<std::vector<Eigen::Index>> members(clusters_.size());
    for (Eigen::Index i = 0; i < signals_.cols(); ++i)
      members[size_t(clusterOf_[size_t(i)])].push_back(i);
    for (size_t c = 0; c < members.size(); ++c)
      if (!members[c].empty()) clusters_[c] = analysed(signals_, members[c], most_);
  }

  ClusteredPca result() const {
    ClusteredPca all;
    all.clusterOf = clusterOf_;
    for (const Affine& cluster : clusters_) {
      const float* vectors = cluster.vectors.data();
      all.clusters.push_back(
          {toVector(cluster.mean),
           {size_t(signals_.rows()), {vectors, vectors + cluster.vectors.size()}}});
    }
    double left = 0;
    for (Eigen::Index i = 0; i < signals_.cols(); ++i) {
      const Affine& cluster = clusters_[size_t(clusterOf_[size_t(i)])];
      const VectorXf centred = signals_.col(i) - cluster.mean;
      all.weights.push_back(toVector(cluster.vectors.transpose() * centred));
      left += residual(cluster, signals_.col(i));
    }
    const double squares = signals_.cast<double>().squaredNorm();
    all.error = squares > 0 ? std::sqrt(left / squares) : 0;
    return all;
  }

 private:
  const MatrixXf& signals_;
  int most_;
  std::vector<Affine> clusters_;
  std::vector<int> clusterOf_;
};

}  // namespace

ClusteredPca clusteredPca(const Signals& signals, int clusters, int vectors, int rounds) {
  if (clusters < 1 || vectors < 0 || signals.count() < 1)
    throw std::invalid_argument("clusteredPca: needs a signal, a cluster and vectors >= 0");
  const MatrixXf columns = Eigen::Map<const MatrixXf>(
      signals.values.data(), Eigen::Index(signals.length), Eigen::Index(signals.count()));
  Analysis analysis(columns, int(std::min(size_t(clusters), signals.count())), vectors);
  for (int i = 0; i < rounds; ++i) {
    analysis.analyse();
    if (!analysis.assign()) break;
  }
  analysis.analyse();
  return analysis.result();
}

}  // namespace chromeball
