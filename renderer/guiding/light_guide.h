// SPDX-License-Identifier: Apache-2.0
// Guided light samples: which directions the probe lights each region of the scene from, learned
// from the paths so far. The strategies do not know what is in front of the probe; in a room, they
// send nearly all light samples to its walls.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/archive.h"
#include "guiding/region_tree.h"
#include "math/vec.h"

namespace chromeball {

// A density over directions that is learned from samples: constant in the leaves of a quadtree
// (Mueller, Gross, Novak, "Practical Path Guiding for Efficient Light-Transport Simulation", 2017).

// The quadtree divides the unit square, which squareToUniformSphere() maps to the sphere with a
// constant ratio of areas.
class DirectionTree {
 public:
  // A point of the square with its weight, >= 0.
  struct Point {
    vec2 position;
    float weight;
  };

  // Uniform over the sphere.
  DirectionTree() = default;
  // The probability of a square that is divided follows the weights of the points in it. Reorders
  // the points.
  explicit DirectionTree(std::span<Point> points);

  struct Sample {
    vec3 direction;  // unit
    float pdf;       // over solid angle
  };
  Sample sample(vec2 u) const;
  float pdf(const vec3& direction) const;  // over solid angle; always positive

  void archive(Archive& a) {
    a(nodes_);
    a.check(!nodes_.empty());
    for (size_t i = 0; i < nodes_.size(); ++i)
      for (const uint16_t child : nodes_[i].children)
        a.check(child == 0 || (child > i && child < nodes_.size()));
  }

  size_t byteCount() const { return nodes_.size() * sizeof(Node); }

 private:
  struct Node {
    float left = 0.5f;                       // probability of x < 1/2
    std::array<float, 2> lower{0.5f, 0.5f};  // of y < 1/2, in the left and in the right half
    std::array<uint16_t, 4> children{};      // of the quarters x + 2 y; 0: constant density
  };
  struct Square {
    vec2 corner;
    float size;
  };
  void divide(std::span<Point> points, const Square& square, int depth, double total);

  std::vector<Node> nodes_{Node()};
};

// Light from the probe that a light sample or a BSDF sample found at a vertex.
struct LightRecord {
  vec3 position, normal;  // of the vertex
  vec3 direction;         // unit, towards the light
  float integrand;        // f cos L, luminance
  float density;          // pdf of the direction by both techniques together
  float strategyPdf;      // of the strategy's light samples, without the guide
  float bsdfPdf;
};

// A region of the guide. Light samples are drawn from a mixture of the strategy and the region's
// tree (one-sample model; Veach 1997, section 9.2.4).
class GuideRegion {
 public:
  GuideRegion() = default;
  // Learns the tree, and the fraction of light samples that the strategy keeps.
  explicit GuideRegion(std::span<const LightRecord> records);

  bool isGuided() const { return strategyFraction_ < 1; }
  float strategyFraction() const { return strategyFraction_; }
  const DirectionTree& tree() const { return tree_; }

  // Pdf of the mixture.
  float pdf(float strategyPdf, float treePdf) const {
    return strategyFraction_ * strategyPdf + (1 - strategyFraction_) * treePdf;
  }
  float pdf(float strategyPdf, const vec3& direction) const {
    return pdf(strategyPdf, tree_.pdf(direction));
  }

  // Second moments of the direct light found with one sample of each technique: without the guide,
  // and with it; sums over the records. Their ratio estimates what the guide gains.
  struct Moments {
    double without = 0, with = 0;
  };
  const Moments& moments() const { return moments_; }

  void archive(Archive& a) {
    tree_.archive(a);
    a(strategyFraction_);
    a(moments_);
    a.check(strategyFraction_ >= 0 && strategyFraction_ <= 1);
  }

 private:
  DirectionTree tree_;
  float strategyFraction_ = 1;
  Moments moments_;
};

class LightGuide {
 public:
  // Replaces what has been learned before.
  void learn(std::vector<LightRecord> records);
  void forget() { *this = LightGuide(); }

  // Whether nothing is guided: find() returns null everywhere.
  bool empty() const { return tree_.empty(); }
  // Null where the strategy alone is better.
  const GuideRegion* find(const vec3& position, const vec3& normal) const {
    if (empty()) return nullptr;
    const GuideRegion& region = regions_[tree_.find(position, normal)];
    return region.isGuided() ? &region : nullptr;
  }

  size_t guidedRegions() const;
  GuideRegion::Moments moments() const;  // of all regions

  void archive(Archive& a) {
    a(regions_);
    tree_.archive(a, regions_.size());
  }

 private:
  RegionTree tree_;
  std::vector<GuideRegion> regions_;
};

}  // namespace chromeball
