// SPDX-License-Identifier: Apache-2.0
// `kollig-keller-strata`: one random direction in each region of the probe, unbiased (Kollig and
// Keller 2003, with the radiance of the direction instead of the region's mean).
#pragma once

#include "lighting/constellation/spherical_kmeans.h"
#include "lighting/luminance_field.h"
#include "lighting/probe_light.h"
#include "math/cdf.h"

namespace chromeball {

// The cells of one region, sampled with probability proportional to their weights.
class Stratum {
 public:
  // Add cells row by row. The weight must be positive.
  void add(int column, int row, double weight);

  double weight() const { return sums_.empty() ? 0 : sums_.back(); }

  // Chooses the row by `v` and the column by `u`, and replaces them by the position in the cell, in
  // [0, 1).
  struct Cell {
    int column, row;
  };
  Cell choose(double& u, double& v) const;

 private:
  struct Run {
    int row;
    uint32_t first;  // index of the row's first cell
    double before;   // sum of the weights of all rows above
  };
  std::vector<Run> runs_;
  std::vector<int32_t> columns_;
  std::vector<double> sums_;  // of the weights up to and including this cell
};

// The regions are the same as kollig-keller's; they are small where the probe is bright. The first
// hit takes one sample in each region, with pdf proportional to luminance. Later hits take kLater
// samples, in regions chosen with probability proportional to their energy.
class Strata : public ProbeLight {
 public:
  static constexpr int kLater = 1;  // samples

  // Throws InputError for an invalid probe (TexelTable).
  Strata(const Probe& probe, int regions);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;

  // There may be fewer regions than requested.
  int regions() const { return int(strata_.size()); }
  int regionOf(const vec3& wi) const { return regionOf(probe_.locate(wi)); }
  // The sample of a region at the first hit, from two numbers in [0, 1).
  DirectionSample sampleRegion(int region, double u, double v) const;

 private:
  int regionOf(const Probe::Position& p) const {
    return partition_.label[size_t(std::max(p.row - 1, 0)) * probe_.width() + p.column];
  }
  // Factor from the field's weight to the pdf over solid angle.
  float pdfScale(int region, int depth) const;
  DirectionSample sampleCells(int region, double u, double v, float scale) const;

  LuminanceField field_;
  Partition partition_;  // of cells, each in the region of the texel at its upper left corner
  std::vector<Stratum> strata_;
  CdfRows choice_;
  double total_ = 0;
};

}  // namespace chromeball
