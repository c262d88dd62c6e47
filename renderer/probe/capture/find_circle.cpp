// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/find_circle.h"

#include <random>
#include <vector>

namespace chromeball {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kLongestSide = 400;      // of the copy
constexpr double kEdges = 0.3;         // share of its pixels
constexpr double kAligned = 0.95;      // cosine between an edge's normal and the circle's
constexpr double kLeastRadius = 0.05;  // over the shorter side
constexpr double kLeastSupport = 0.5;
constexpr double kLeastInside = 0.5;  // of the outline
// Limits for the final fit. Agreement: places without a ball have at most 0.55 of a circle on
// edges, and a third of its arcs agree. Error: in pixels. Contradiction, relative to the arcs that
// agree: balls have at most 0.61, octagons whose sides are not shorter than 50 pixels have 1 and
// more.
constexpr double kLeastAgreement = 0.95, kLargestError = 1, kMostContradiction = 0.75;

// Limits for a second circle: its support, and its radius over that of the first. Edges that a ball
// reflects are shorter or smaller circles.
constexpr double kLeastOfOther = 0.55, kSmallestOther = 0.4;

// Limits for the deviations that repeat around the outline: for balls they are at most a third of
// the mean square, for dodecagons 0.4 to 0.98 of it, and more than half a pixel.
constexpr double kMostRipple = 0.5, kMostRippleShare = 0.38;

// The part of a circle that lies on edges. Its rank is the length of the outline on edges beyond
// what random edges would give.
struct Support {
  double share = 0, inside = 0, rank = 0;
};

bool hasPossibleRadius(const EdgeMap& edges, const Circle& circle) {
  const double shortest = std::min(edges.width, edges.height);
  return circle.radius >= kLeastRadius * shortest && circle.radius <= shortest;
}

dvec2 outward(double angle) { return {std::cos(angle), std::sin(angle)}; }

bool isInside(const EdgeMap& edges, const dvec2& p) {
  return p.x >= 1 && p.y >= 1 && p.x < edges.width - 1 && p.y < edges.height - 1;
}

// Whether an edge across the circle is within about a pixel of its point at `angle`.
bool isOnEdge(const EdgeMap& edges, const Circle& circle, const dvec2& normal) {
  for (int step = -1; step <= 1; ++step) {
    const dvec2 p = circle.centre + (circle.radius + step) * normal;
    const EdgePoint* edge = edges.at(int(std::floor(p.x)), int(std::floor(p.y)));
    if (edge && std::fabs(glm::dot(edge->normal, normal)) > kAligned) return true;
  }
  return false;
}

Support support(const EdgeMap& edges, const Circle& circle, int mostSteps = 360) {
  constexpr double kRandom = 0.2;
  const int steps = std::clamp(int(2 * kPiD * circle.radius), 32, mostSteps);
  int inside = 0, onEdge = 0;
  for (int i = 0; i < steps; ++i) {
    const dvec2 normal = outward(2 * kPiD * i / steps);
    if (!isInside(edges, circle.centre + circle.radius * normal)) continue;
    ++inside;
    onEdge += isOnEdge(edges, circle, normal);
  }
  if (inside == 0) return {};
  const double share = double(onEdge) / inside, part = double(inside) / steps;
  return {share, part, (share - kRandom) * part * circle.radius};
}

// The circle through two edges: its centre is where their normals meet. nullopt if they do not
// agree on a radius.
std::optional<Circle> circleThrough(const EdgePoint& a, const EdgePoint& b) {
  constexpr double kSameRadius = 0.1, kLeastCrossing = 0.2;
  const double crossing = a.normal.x * b.normal.y - a.normal.y * b.normal.x;
  if (std::fabs(crossing) < kLeastCrossing) return std::nullopt;
  const dvec2 between = b.position - a.position;
  const double s = (between.x * b.normal.y - between.y * b.normal.x) / crossing;
  const dvec2 centre = a.position + s * a.normal;
  const double first = std::fabs(s), second = glm::distance(centre, b.position);
  if (std::fabs(first - second) > kSameRadius * std::max(first, second)) return std::nullopt;
  return Circle{centre, 0.5 * (first + second)};
}

// The least-squares fit of a circle to points, by Gauss-Newton; the largest distances count less
// (Tukey's weights at `width`).
Circle fitted(Circle circle, const std::vector<dvec2>& points, double width) {
  for (int step = 0; step < 20; ++step) {
    glm::dmat3 normalMatrix(0);
    dvec3 right(0);
    for (const dvec2& p : points) {
      const dvec2 fromCentre = p - circle.centre;
      const double distance = glm::length(fromCentre), error = distance - circle.radius;
      const double t = error / width;
      if (distance == 0 || std::fabs(t) >= 1) continue;
      const double w = (1 - t * t) * (1 - t * t);
      const dvec3 row(fromCentre / distance, 1);
      normalMatrix += w * glm::outerProduct(row, row);
      right += w * error * row;
    }
    if (std::fabs(glm::determinant(normalMatrix)) < 1e-9) break;
    const dvec3 change = glm::inverse(normalMatrix) * right;
    circle.centre += dvec2(change);
    circle.radius += change.z;
    if (glm::length(change) < 1e-6) break;
  }
  return circle;
}

// The index of the outermost maximum among steps of at least a share of the largest; else the index
// of the largest step. Inside the rim of a ball the reflected scene is compressed to strong edges,
// and the rim itself may be the weaker step: it is the last one.
size_t outermostStep(const std::vector<double>& steps) {
  constexpr double kShare = 0.35;
  const auto largest = std::max_element(steps.begin(), steps.end());
  for (size_t k = steps.size() - 2; k > 0; --k)
    if (steps[k] >= kShare * *largest && steps[k] >= steps[k - 1] && steps[k] > steps[k + 1])
      return k;
  return size_t(largest - steps.begin());
}

// The point of the outermost step across the circle along each of many radii, within `reach` of it.
std::vector<dvec2> stepsAcross(const Image& channel, const Circle& circle, double reach) {
  constexpr double kStep = 0.25, kLeast = 0.05;
  const int radii = std::clamp(int(2 * kPiD * circle.radius), 64, 2000);
  const int half = int(reach / kStep);
  std::vector<double> steps(size_t(2 * half + 1));
  std::vector<dvec2> points;
  for (int i = 0; i < radii; ++i) {
    const dvec2 normal = outward(2 * kPiD * i / radii);
    const auto at = [&](size_t k) {
      return circle.centre + (circle.radius + (double(k) - half) * kStep) * normal;
    };
    for (size_t k = 0; k < steps.size(); ++k) {
      const dvec2 p = at(k);
      const bool isShown =
          p.x >= 1 && p.y >= 1 && p.x <= channel.width - 1 && p.y <= channel.height - 1;
      steps[k] =
          isShown ? std::fabs(interpolate(channel, p + normal) - interpolate(channel, p - normal))
                  : 0;
    }
    if (*std::max_element(steps.begin(), steps.end()) > kLeast)
      points.push_back(at(outermostStep(steps)));
  }
  return points;
}

Circle refined(const Image& channel, Circle circle) {
  for (double reach = 6; reach > 0.9; reach *= 0.6)
    circle = fitted(circle, stepsAcross(channel, circle, reach), reach);
  return circle;
}

// The circle fitted to the edges across it, first within 4 pixels, finally within 1.
Circle fittedToEdges(const EdgeMap& edges, Circle circle) {
  for (double reach = 4; reach >= 1; reach *= 0.5) {
    std::vector<dvec2> points;
    for (const EdgePoint& edge : edges.points) {
      const dvec2 fromCentre = edge.position - circle.centre;
      const double distance = glm::length(fromCentre);
      if (std::fabs(distance - circle.radius) < reach &&
          std::fabs(glm::dot(edge.normal, fromCentre)) > kAligned * distance)
        points.push_back(edge.position);
    }
    circle = fitted(circle, points, 1.5 * reach);
  }
  return circle;
}

// Whether the circles have different outlines: nowhere near each other for most of their length.
bool differ(const Circle& a, const Circle& b) {
  constexpr double kLeast = 0.06;  // of the radius
  return glm::distance(a.centre, b.centre) + std::fabs(a.radius - b.radius) >
         kLeast * std::max(a.radius, b.radius);
}

// The circles that pairs of edges propose, the best first; only those that differ from `known`.
std::vector<Circle> proposals(const EdgeMap& edges, const std::optional<Circle>& known) {
  constexpr int kPairs = 200000;
  constexpr size_t kMost = 200;
  struct Ranked {
    Circle circle;
    double rank;
  };
  std::vector<Ranked> best;
  const auto isBetter = [](const Ranked& a, const Ranked& b) { return a.rank > b.rank; };
  std::mt19937 random(1);
  const auto any = [&]() -> const EdgePoint& {
    return edges.points[random() % edges.points.size()];
  };
  for (int i = 0; i < kPairs && !edges.points.empty(); ++i) {
    const EdgePoint &a = any(), &b = any();
    const std::optional<Circle> circle = circleThrough(a, b);
    if (!circle || !hasPossibleRadius(edges, *circle)) continue;
    if (known && !differ(*circle, *known)) continue;
    best.push_back({*circle, support(edges, *circle, 90).rank});
    std::push_heap(best.begin(), best.end(), isBetter);
    if (best.size() <= kMost) continue;
    std::pop_heap(best.begin(), best.end(), isBetter);  // the worst
    best.pop_back();
  }
  std::sort_heap(best.begin(), best.end(), isBetter);
  std::vector<Circle> circles;
  for (const Ranked& ranked : best) circles.push_back(ranked.circle);
  return circles;
}

// The best circle of the copy that differs from `known`, or nullopt.
std::optional<FoundCircle> best(const EdgeMap& edges, const std::optional<Circle>& known) {
  std::optional<FoundCircle> found;
  double bestRank = 0;
  for (const Circle& proposal : proposals(edges, known)) {
    const Circle circle = fittedToEdges(edges, proposal);
    if (known && !differ(circle, *known)) continue;
    const Support here = support(edges, circle);
    if (here.rank <= bestRank || here.share < kLeastSupport || here.inside < kLeastInside ||
        !hasPossibleRadius(edges, circle))
      continue;
    found = FoundCircle{circle, here.share, 0, {}};
    bestRank = here.rank;
  }
  return found;
}

// Whether the circle is an edge of the picture, not a contour of a smooth one: along a quarter of
// its radii at least, the steepest slope at the circle is well above the mean slope around it; they
// are equal where radiance changes smoothly. Balls have more than 3 times that.
bool isSharp(const Image& channel, const Circle& circle) {
  constexpr int kRadii = 360, kAround = 6;
  constexpr double kLeastRatio = 1.5, kLeastShare = 0.25, kNoSlope = 1e-3;
  int shown = 0, sharp = 0;
  for (int i = 0; i < kRadii; ++i) {
    const dvec2 normal = outward(2 * kPiD * i / kRadii);
    const auto at = [&](double distance) {
      return circle.centre + (circle.radius + distance) * normal;
    };
    const dvec2 end = at(kAround + 1);
    if (end.x < 1 || end.y < 1 || end.x > channel.width - 1 || end.y > channel.height - 1) continue;
    const auto slope = [&](double distance) {
      return std::fabs(interpolate(channel, at(distance + 1)) -
                       interpolate(channel, at(distance - 1)));
    };
    double steepest = 0, around = 0;
    for (int k = -2; k <= 2; ++k) steepest = std::max(steepest, slope(0.5 * k));
    for (int k = 2; k <= kAround; ++k) around += slope(k) + slope(-k);
    ++shown;
    sharp += steepest > kLeastRatio * (around / (2 * (kAround - 1)) + kNoSlope);
  }
  return sharp >= kLeastShare * shown;
}

// Whether the outline is a polygon. To be called with the circle that was found: from another one
// the search ends short of some deviations.
bool isPolygon(const Image& image, const Circle& circle) {
  const std::optional<Outline> outline = fitOutline(image, circle);
  return outline && outline->ripple > kMostRipple && outline->rippleShare > kMostRippleShare;
}

// A picture and its copy.
struct Search {
  const Image& image;
  int scale;
  Image small;  // logarithm of luminance
  EdgeMap edges;

  Search(const Image& whole, int factor)
      : image(whole),
        scale(factor),
        small(logarithm(meanLuminance(whole, factor))),
        edges(small, kEdges) {}
};

// The best circle that differs from `known`, a circle of the picture.
std::optional<FoundCircle> find(const Search& search, const std::optional<Circle>& known) {
  const double scale = search.scale;
  std::optional<Circle> inCopy = known;
  if (inCopy) inCopy->centre /= scale, inCopy->radius /= scale;
  std::optional<FoundCircle> found = best(search.edges, inCopy);
  if (!found) return std::nullopt;
  Circle& circle = found->circle;
  circle.centre *= scale, circle.radius *= scale;
  for (int finer = search.scale; finer >= 1; finer /= 2) {
    circle.centre /= finer, circle.radius /= finer;
    circle = refined(
        finer == search.scale ? search.small : logarithm(meanLuminance(search.image, finer)),
        circle);
    circle.centre *= finer, circle.radius *= finer;
  }
  const std::optional<Outline> outline = fitOutline(search.image, circle);
  if (!outline || found->support + outline->support < kLeastAgreement ||
      !(outline->standardError < kLargestError) ||
      outline->contradiction > kMostContradiction * outline->support ||
      !isSharp(search.small, {outline->circle.centre / scale, outline->circle.radius / scale}) ||
      isPolygon(search.image, outline->circle))
    return std::nullopt;
  return FoundCircle{outline->circle, outline->support, outline->standardError, {}};
}

}  // namespace

std::optional<FoundCircle> findCircle(const Image& image) {
  const int longest = std::max(image.width, image.height);
  const int scale = (longest + kLongestSide - 1) / kLongestSide;
  if (std::min(image.width, image.height) / scale < 8) return std::nullopt;
  const Search search(image, scale);
  std::optional<FoundCircle> found = find(search, {});
  if (!found) return std::nullopt;
  const std::optional<FoundCircle> other = find(search, found->circle);
  if (other && other->support > kLeastOfOther && differ(other->circle, found->circle) &&
      other->circle.radius > kSmallestOther * found->circle.radius)
    found->other = other->circle;
  return found;
}

}  // namespace chromeball
