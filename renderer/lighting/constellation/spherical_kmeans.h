// SPDX-License-Identifier: Apache-2.0
// K-means on the sphere, Lloyd's iteration over the cells of a map, weighted by luminance, and the
// methods that start it: `lightgen`, `kollig-keller`.
#pragma once

#include <cstdint>
#include <vector>

#include "lighting/constellation/directional_light.h"
#include "lighting/constellation/texel_table.h"

namespace chromeball {

// Minimises the sum over cells of weight x (1 - direction . nearest centre), half the squared
// chord. The optimal centre of a cluster is then its normalised centroid (Dhillon and Modha 2001).
class SphericalKMeans {
 public:
  // Uses the lit cells of `table`, which must outlive this.
  explicit SphericalKMeans(const TexelTable& table);

  int litCells() const { return int(points_.size()); }
  double weight(int litCell) const { return points_[litCell].weight; }

  // Adds a centre at a lit cell, or at the worst cell: in the cluster with the largest error, among
  // those with two or more cells, the cell with the largest error. (Such a cluster exists while
  // there are fewer centres than lit cells.) The first centre is at the brightest cell.
  void addCentre(int litCell);
  void addCentreAtWorst() { addCentre(worst()); }

  // Assigns cells to the nearest centres and moves the centres to the centroids; a centre without
  // cells moves to the worst cell. Returns whether any centre moved. Never increases the objective.
  // Needs at least as many lit cells as centres.
  bool step();

  // Repeats step() until it decreases the objective by at most the fraction `tolerance`; at most
  // 200 times.
  void converge(double tolerance);

  double objective() const;  // after the last assignment
  int centres() const { return int(centres_.size()); }
  Constellation lights() const;  // one for each centre

  // The centre of each texel of the table's map: of a black cell the nearest; no region without
  // centres.
  Partition partition(const Image& latLong) const;

 private:
  struct Point {
    dvec3 direction;
    double weight;
    int cell;  // in the table
  };
  // A centre that may be nearer to some cells of a cluster than the cluster's own centre.
  struct Rival {
    double cosine;  // of the angle between both centres
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
  std::vector<int> label_;      // the centre of each point; -1 before the first centre is added
  std::vector<double> cosine_;  // of the angle between a point and its centre
  std::vector<dvec3> centres_;
  std::vector<char> moved_;   // since the last assignment
  std::vector<int> members_;  // points of each centre
};

// `kollig-keller` (Kollig and Keller, "Efficient Illumination by High Dynamic Range Images", EGSR
// 2003): K-means on the sphere that adds one light at a time.

// The first light is at the brightest cell. Each further light is added in the region with the
// largest error, sum of weight (1 - cos to its light), at the cell with the largest error; then all
// lights move by Lloyd's iteration until a step gains less than a thousandth, after the last light
// to convergence. Deterministic. From about 32 lights on the error is less than lightgen's; with
// fewer, lightgen's four random starts are sometimes better by a few percent.
SphericalKMeans kolligKellerClusters(const TexelTable& table, int count);

// The regions of its lights in a coarse table of the map.
Partition kolligKellerRegions(const Image& latLong, int count);

// `kollig-keller-strata` (the same paper, against aliasing): each light has a random direction in
// its region, with probability proportional to luminance and uniform within a texel, and the
// irradiance of the region.
Constellation kolligKellerStrata(const Image& latLong, int count, uint64_t seed);

// `lightgen` (Cohen and Debevec, HDRShop plug-in, 2001; HDRI book, section 9.6.2): K-means on the
// sphere from random starts. Lights start at `count` different cells, drawn with probability
// proportional to luminance, and move by Lloyd's iteration to convergence. The result is the one
// with the smallest objective (SphericalKMeans::objective()) out of four starts.
SphericalKMeans lightGenClusters(const TexelTable& table, int count, uint64_t seed);

}  // namespace chromeball
