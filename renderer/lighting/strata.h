// SPDX-License-Identifier: Apache-2.0
// `kollig-keller-strata` without bias: one random direction in each region of the probe.
#pragma once

#include "lighting/constellation/kollig_keller.h"
#include "lighting/luminance_field.h"
#include "lighting/strategy.h"
#include "math/cdf.h"

namespace chromeball {

// The cells of one region, to be chosen in proportion to their weights.
class Stratum {
 public:
  // Cells come row by row; the weight is positive.
  void add(int column, int row, double weight);

  double weight() const { return sums_.empty() ? 0 : sums_.back(); }

  // `v` chooses the row, `u` the column; each becomes the position inside, in [0, 1).
  struct Cell {
    int column, row;
  };
  Cell choose(double& u, double& v) const;

 private:
  struct Run {
    int row;
    uint32_t first;  // of the row's cells
    double before;   // sum of the weights of all rows above
  };
  std::vector<Run> runs_;
  std::vector<int32_t> columns_;
  std::vector<double> sums_;  // of the weights up to this cell and with it
};

// The regions are those of Kollig and Keller's lights (2003), which are small where there is much
// light. At the first hit each region gets a direction in proportion to luminance, with the
// radiance that is there; later hits get kLater directions, from regions in proportion to their
// light.
class Strata : public LightingStrategy {
 public:
  static constexpr int kLater = 1;

  // Throws InputError as makeConstellation() does.
  Strata(const Probe& probe, int regions);

  void sample(const LightPoint& point, const PixelSampler& sampler,
              std::vector<DirectionSample>& out) const override;
  Escaped escaped(const LightPoint& point, const vec3& wi) const override;
  Rgb background(const vec3&, const vec3& wi) const override { return probe_.radiance(wi); }
  bool unbiased() const override { return true; }

  // In terms of two numbers in [0, 1), for tests. There may be fewer regions than were asked for.
  int regions() const { return int(strata_.size()); }
  int regionOf(const vec3& wi) const { return regionOf(probe_.locate(wi)); }
  DirectionSample sampleRegion(int region, double u, double v) const;

 private:
  int regionOf(const Probe::Position& p) const {
    return partition_.label[size_t(std::max(p.row - 1, 0)) * probe_.width() + p.column];
  }
  // Pdf over solid angle for each unit of the field's, at the first hit and later.
  float densityScale(int region, int depth) const;
  DirectionSample sampleCells(int region, double u, double v, float scale) const;

  const Probe& probe_;
  LuminanceField field_;
  Partition partition_;  // of cells, by the texel in their upper left corner
  std::vector<Stratum> strata_;
  CdfRows choice_;
  double total_ = 0;
};

}  // namespace chromeball
