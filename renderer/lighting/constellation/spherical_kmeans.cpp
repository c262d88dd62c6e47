// SPDX-License-Identifier: Apache-2.0
#include "lighting/constellation/spherical_kmeans.h"

#include "base/progress.h"

namespace chromeball {
namespace {

constexpr int kMaxSteps = 200;

// cos(2 a) from cos(a) for a < 90 degrees; otherwise -2, which is below every cosine.
double cosOfTwice(double cosine) { return cosine > 0 ? 2 * cosine * cosine - 1 : -2; }

}  // namespace

SphericalKMeans::SphericalKMeans(const TexelTable& table) : table_(table) {
  for (int y = 0; y < table.height(); ++y)
    for (int x = 0; x < table.width(); ++x) {
      const TexelSum& cell = table.at(x, y);
      if (!(cell.weight > 0)) continue;
      const double length = glm::length(cell.moment);
      const dvec3 direction =
          length > 1e-6 * cell.weight ? cell.moment / length : table.direction(x + 0.5, y + 0.5);
      points_.push_back({direction, cell.weight, y * table.width() + x});
    }
  label_.assign(points_.size(), -1);
  cosine_.assign(points_.size(), -1);
}

void SphericalKMeans::addCentre(int litCell) {
  centres_.emplace_back();
  moved_.push_back(true);
  members_.push_back(0);
  claim(litCell, centres() - 1);
  for (int& label : label_)
    if (label < 0) label = centres() - 1, ++members_.back();
}

void SphericalKMeans::claim(int litCell, int centre) {
  if (label_[litCell] >= 0) --members_[label_[litCell]];
  ++members_[centre];
  label_[litCell] = centre;
  cosine_[litCell] = 1;
  centres_[centre] = points_[litCell].direction;
  moved_[centre] = true;
}

void SphericalKMeans::updateCosines() {
  for (size_t i = 0; i < points_.size(); ++i)
    if (moved_[label_[i]]) cosine_[i] = glm::dot(points_[i].direction, centres_[label_[i]]);
}

// The centres that may be nearer to a cell of this cluster than `centre`, sorted by distance from
// `centre`. `minCosine`: the cosine of the angle between `centre` and the cluster's farthest cell.
// Pairs of centres that have not moved since the last assignment are left out.
std::vector<SphericalKMeans::Rival> SphericalKMeans::rivals(int centre,
                                                            const std::vector<int>& moved,
                                                            double minCosine) const {
  std::vector<Rival> found;
  const double reach = cosOfTwice(minCosine);
  const auto consider = [&](int other) {
    const double cosine = glm::dot(centres_[centre], centres_[other]);
    if (other != centre && cosine >= reach) found.push_back({cosine, other});
  };
  if (moved_[centre])
    for (int other = 0; other < centres(); ++other) consider(other);
  else
    for (int other : moved) consider(other);
  std::sort(found.begin(), found.end(), [](const Rival& a, const Rival& b) {
    return a.cosine != b.cosine ? a.cosine > b.cosine : a.centre < b.centre;
  });
  return found;
}

// Triangle inequality: if another centre is nearer to a cell than the cell's own centre c at
// distance d, its distance from c is less than 2 d (Hamerly 2010).
void SphericalKMeans::assign() {
  updateCosines();
  std::vector<double> minimum(centres_.size(), 1);
  for (size_t i = 0; i < points_.size(); ++i)
    minimum[label_[i]] = std::min(minimum[label_[i]], cosine_[i]);
  std::vector<int> moved;
  for (int i = 0; i < centres(); ++i)
    if (moved_[i]) moved.push_back(i);
  std::vector<std::vector<Rival>> rivalsOf(centres_.size());
  for (int i = 0; i < centres(); ++i) rivalsOf[i] = rivals(i, moved, minimum[i]);

  for (size_t i = 0; i < points_.size(); ++i) {
    const int before = label_[i];
    const double reach = cosOfTwice(cosine_[i]);
    for (const Rival& rival : rivalsOf[before]) {
      if (rival.cosine < reach) break;
      const double cosine = glm::dot(points_[i].direction, centres_[rival.centre]);
      if (cosine > cosine_[i]) cosine_[i] = cosine, label_[i] = rival.centre;
    }
    --members_[before];
    ++members_[label_[i]];
  }
  std::fill(moved_.begin(), moved_.end(), false);
}

bool SphericalKMeans::moveCentres() {
  for (size_t i = 0; i < centres_.size(); ++i)
    if (members_[i] == 0) claim(worst(), int(i));
  std::vector<dvec3> moments(centres_.size(), dvec3(0));
  for (size_t i = 0; i < points_.size(); ++i)
    moments[label_[i]] += points_[i].direction * points_[i].weight;
  for (size_t i = 0; i < centres_.size(); ++i) {
    const double length = glm::length(moments[i]);
    if (!(length > 0)) continue;
    const dvec3 centre = moments[i] / length;
    if (centre != centres_[i]) moved_[i] = true;
    centres_[i] = centre;
  }
  return std::find(moved_.begin(), moved_.end(), true) != moved_.end();
}

bool SphericalKMeans::step() {
  endIfCancelled();
  assign();
  return moveCentres();
}

void SphericalKMeans::converge(double tolerance) {
  double before = objective();
  for (int i = 0; i < kMaxSteps && step(); ++i) {
    const double now = objective();
    if (before - now <= tolerance * before) break;
    before = now;
  }
}

int SphericalKMeans::worst() const {
  const auto error = [&](int i) { return points_[i].weight * (1 - cosine_[i]); };
  std::vector<double> ofCluster(centres_.size());
  for (int i = 0; i < litCells(); ++i)
    if (label_[i] >= 0) ofCluster[label_[i]] += error(i);
  for (int i = 0; i < centres(); ++i)
    if (members_[i] < 2) ofCluster[i] = -1;
  const int cluster = int(std::max_element(ofCluster.begin(), ofCluster.end()) - ofCluster.begin());
  int worst = -1;
  for (int i = 0; i < litCells(); ++i)
    if ((label_[i] < 0 || label_[i] == cluster) && (worst < 0 || error(i) > error(worst)))
      worst = i;
  return worst;
}

double SphericalKMeans::objective() const {
  double sum = 0;
  for (int i = 0; i < litCells(); ++i) sum += points_[i].weight * (1 - cosine_[i]);
  return sum;
}

Partition SphericalKMeans::partition(const Image& latLong) const {
  Partition partition{centres(), {}};
  if (centres() == 0) return partition;
  std::vector<int> labels(table_.cells().size(), -1);  // of the cells, lit or not
  for (int i = 0; i < litCells(); ++i) labels[points_[i].cell] = label_[i];
  for (size_t cell = 0; cell < labels.size(); ++cell) {
    if (labels[cell] >= 0) continue;
    const int x = int(cell % table_.width()), y = int(cell / table_.width());
    const dvec3 direction = table_.direction(x + 0.5, y + 0.5);
    double nearest = -2;
    for (int i = 0; i < centres(); ++i) {
      const double cosine = glm::dot(direction, centres_[i]);
      if (cosine > nearest) nearest = cosine, labels[cell] = i;
    }
  }
  partition.label.reserve(size_t(latLong.width) * latLong.height);
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x)
      partition.label.push_back(uint16_t(labels[table_.cellOfTexel(x, y)]));
  return partition;
}

Constellation SphericalKMeans::lights() const {
  std::vector<TexelSum> sums(centres_.size());
  for (int i = 0; i < litCells(); ++i) sums[label_[i]] += table_.cells()[points_[i].cell];
  Constellation lights;
  for (int i = 0; i < centres(); ++i) lights.push_back(lightAt(sums[i], centres_[i]));
  return lights;
}

}  // namespace chromeball
