// SPDX-License-Identifier: Apache-2.0
// A density over directions that is learned from samples: constant in the leaves of a quadtree
// (Mueller, Gross, Novak, "Practical Path Guiding for Efficient Light-Transport Simulation", 2017).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/archive.h"
#include "math/vec.h"

namespace chromeball {

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

}  // namespace chromeball
