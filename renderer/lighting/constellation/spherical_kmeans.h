// SPDX-License-Identifier: Apache-2.0
// K-means on the sphere: Lloyd's iteration over the cells of a map, with luminance as their mass.
#pragma once

#include <vector>

#include "lighting/constellation/texel_table.h"

namespace chromeball {

// Minimises the sum over cells of weight (1 - direction . centre), each cell with its nearest
// centre: half the squared chord. The best centre of a cluster is then its normalised centroid.
class SphericalKMeans {
 public:
  // Only the lit cells of `table`, which must outlive this, take part.
  explicit SphericalKMeans(const TexelTable& table);

  int litCells() const { return int(points_.size()); }
  double weight(int litCell) const { return points_[litCell].weight; }

  // Adds a centre at a lit cell; or in the cluster of most error, of those with two cells or more,
  // at the cell that has most of it. There are such clusters while there are fewer centres than
  // lit cells. The first centre goes to the brightest cell.
  void addCentre(int litCell);
  void addCentreAtWorst() { addCentre(worst()); }

  // Assigns cells to the nearest centres and moves these to the centroids; a centre left without
  // cells moves to the worst cell. False where no centre has moved. The objective never rises.
  // There must be no more centres than lit cells.
  bool step();

  // Steps until none lowers the objective by more than the share `tolerance`, or 200 times.
  void converge(double tolerance);

  double objective() const;  // after the last assignment
  int centres() const { return int(centres_.size()); }
  Constellation lights() const;     // one for each centre
  std::vector<int> labels() const;  // for each cell of the table, lit or not, its centre

 private:
  struct Point {
    dvec3 direction;
    double weight;
    int cell;  // in the table
  };
  struct Rival {
    double cosine;  // of the angle between two centres
    int centre;
  };

  void claim(int litCell, int centre);
  void updateCosines();
  std::vector<Rival> rivals(int centre, const std::vector<int>& moved, double minCosine) const;
  void assign();
  bool moveCentres();
  int worst() const;

  const TexelTable& table_;
  std::vector<Point> points_;
  std::vector<int> label_;      // of each point: its centre; -1 before there is one
  std::vector<double> cosine_;  // of the angle between a point and its centre
  std::vector<dvec3> centres_;
  std::vector<char> moved_;   // since the last assignment
  std::vector<int> members_;  // points of each centre
};

}  // namespace chromeball
