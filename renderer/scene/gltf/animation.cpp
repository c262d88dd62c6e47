// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/text.h"
#include "scene/gltf/accessor.h"
#include "scene/motion.h"

namespace chromeball {
namespace {

using tinygltf::Animation;

// Finds an animation by its name, or by its index if it has no name; the first if `when` has none.
size_t findAnimation(const GltfFile& file, const AnimationTime& when) {
  const auto& animations = file.model.animations;
  if (animations.empty()) file.fail("has no animations ({})", when.location);
  if (when.name.empty()) return 0;
  std::vector<std::string> names;
  for (size_t i = 0; i < animations.size(); ++i) {
    names.push_back(animationName(animations, i));
    if (names.back() == when.name) return i;
  }
  file.fail("has no animation `{}` ({}); {}", when.name, when.location,
            didYouMean(when.name, {names.begin(), names.end()}));
}

enum class Interpolation { Step, Linear, CubicSpline };

// Numbers per key of a channel; 1 for morph weights, where the number of targets decides; 0 for a
// target that is ignored.
int componentsOf(const std::string& path) {
  if (path == "weights") return 1;
  if (path == "rotation") return 4;
  return path == "translation" || path == "scale" ? 3 : 0;
}

// An animation sampler: keys over time. `values` holds `width` numbers per key; for a cubic spline
// three times as many: in-tangent, value, out-tangent.
struct Track {
  std::string where;  // in the file
  bool isRotation = false;
  Interpolation interpolation = Interpolation::Linear;
  std::vector<float> times;
  std::vector<double> values;
  size_t width = 0;

  const double* key(size_t i, size_t part) const {
    if (interpolation != Interpolation::CubicSpline) return &values[i * width];
    return &values[(3 * i + part) * width];
  }
  const double* inTangent(size_t i) const { return key(i, 0); }
  const double* value(size_t i) const { return key(i, 1); }
  const double* outTangent(size_t i) const { return key(i, 2); }
};

template <int N>
std::vector<double> readNumbers(GltfFile& file, int accessor, const std::string& where) {
  std::vector<double> numbers;
  for (const auto& v : readVectors<N>(file, accessor, where))
    for (int k = 0; k < N; ++k) {
      if (!std::isfinite(v[k])) file.fail("{}: a number is not finite", where);
      numbers.push_back(v[k]);
    }
  return numbers;
}

// `user`: the location of the channel, whose target is not ignored.
Track readTrack(GltfFile& file, size_t animation, const tinygltf::AnimationChannel& channel,
                const std::string& user) {
  const auto& sampler =
      file.at(file.model.animations[animation].samplers, channel.sampler, "samplers", user);
  const int components = componentsOf(channel.target_path);
  Track track;
  track.where = fmt::format("animations[{}].samplers[{}]", animation, channel.sampler);
  track.isRotation = components == 4;
  if (sampler.interpolation == "STEP")
    track.interpolation = Interpolation::Step;
  else if (sampler.interpolation == "CUBICSPLINE")
    track.interpolation = Interpolation::CubicSpline;
  else if (sampler.interpolation != "LINEAR")
    file.fail("{}.interpolation: \"{}\" is not STEP, LINEAR or CUBICSPLINE", track.where,
              sampler.interpolation);
  for (double time : readNumbers<1>(file, sampler.input, track.where + ".input"))
    track.times.push_back(float(time));
  if (!std::is_sorted(track.times.begin(), track.times.end()))
    file.fail("{}.input: the keys are not in ascending order of time", track.where);

  const std::string at = track.where + ".output";
  track.values = components == 1   ? readNumbers<1>(file, sampler.output, at)
                 : components == 3 ? readNumbers<3>(file, sampler.output, at)
                                   : readNumbers<4>(file, sampler.output, at);
  const size_t perKey = track.interpolation == Interpolation::CubicSpline ? 3 : 1;
  track.width = track.values.size() / (perKey * track.times.size());
  if (track.width * perKey * track.times.size() != track.values.size() ||
      (components > 1 ? track.width != size_t(components) : track.width == 0))
    file.fail("{}: {} numbers do not match {} keys", at, track.values.size(), track.times.size());
  return track;
}

glm::dquat quaternion(const double* q) { return {q[3], q[0], q[1], q[2]}; }

// LINEAR: spherical interpolation along the shorter arc. CUBICSPLINE: the interpolated quaternion,
// normalised (appendix C).
std::vector<double> unitRotation(const GltfFile& file, const Track& track, size_t i,
                                 double fraction, const std::vector<double>& interpolated) {
  glm::dquat q = quaternion(interpolated.data());
  if (track.interpolation == Interpolation::Linear && fraction > 0)
    q = glm::slerp(glm::normalize(quaternion(track.value(i))),
                   glm::normalize(quaternion(track.value(i + 1))), fraction);
  const double length = glm::length(q);
  if (!(length > 0) || !std::isfinite(length))
    file.fail("{}.output: a quaternion has length 0", track.where);
  q /= length;
  return {q.x, q.y, q.z, q.w};
}

// Whether `seconds` is before the key. Of a frame's time, which is a double, the key is a rounded
// one: N * (1 / 24) in floats exceeds the double N / 24 by up to 1.5 units in the last place.
bool isBefore(double seconds, float key) {
  constexpr double kRounding = 2 * double(std::numeric_limits<float>::epsilon());
  return key - seconds > kRounding * std::fabs(key);
}

std::vector<double> valueAt(const GltfFile& file, const Track& track, double seconds) {
  const auto& times = track.times;
  const auto after = std::upper_bound(times.begin(), times.end(), seconds, isBefore);
  const size_t i = after == times.begin() ? 0 : size_t(after - times.begin()) - 1;
  double fraction = 0;  // position between keys i and i + 1; below 0 within the rounding of key i
  if (after != times.begin() && after != times.end())
    fraction = (seconds - times[i]) / (double(times[i + 1]) - times[i]);

  std::vector<double> result(track.value(i), track.value(i) + track.width);
  if (fraction > 0 && track.interpolation == Interpolation::Linear)
    for (size_t k = 0; k < track.width; ++k)
      result[k] += fraction * (track.value(i + 1)[k] - track.value(i)[k]);
  if (fraction > 0 && track.interpolation == Interpolation::CubicSpline) {
    const double t = fraction, t2 = t * t, t3 = t2 * t;
    const double duration = double(times[i + 1]) - times[i];
    for (size_t k = 0; k < track.width; ++k)  // cubic Hermite spline; tangents are per second
      result[k] = (2 * t3 - 3 * t2 + 1) * track.value(i)[k] +
                  (t3 - 2 * t2 + t) * duration * track.outTangent(i)[k] +
                  (3 * t2 - 2 * t3) * track.value(i + 1)[k] +
                  (t3 - t2) * duration * track.inTangent(i + 1)[k];
  }
  return track.isRotation ? unitRotation(file, track, i, fraction, result) : result;
}

// Beyond rounding.
bool areDifferent(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr double kRounding = 1e-12;
  double largest = 0, difference = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    largest = std::max({largest, std::fabs(a[k]), std::fabs(b[k])});
    difference = std::max(difference, std::fabs(a[k] - b[k]));
  }
  return difference > kRounding * largest;
}

// Primitives of a mesh have the same number of morph targets (glTF 2.0, 3.7.2.2).
void checkWeights(const GltfFile& file, const tinygltf::Node& node, const Track& track) {
  if (node.mesh < 0 || size_t(node.mesh) >= file.model.meshes.size()) return;
  const auto& primitives = file.model.meshes[size_t(node.mesh)].primitives;
  const size_t targets = primitives.empty() ? track.width : primitives.front().targets.size();
  if (track.width != targets)
    file.fail("{}.output: has {} weights for each key, and meshes[{}] has {} morph targets",
              track.where, track.width, node.mesh, targets);
}

}  // namespace

struct AnimationTracks {
  // By animation, sampler and componentsOf(); channels may share a sampler.
  std::map<std::array<int, 3>, Track> read;
};

namespace {

const Track& trackOf(GltfFile& file, size_t animation, const tinygltf::AnimationChannel& channel,
                     const std::string& user) {
  if (!file.tracks) file.tracks = std::make_shared<AnimationTracks>();
  auto& read = file.tracks->read;
  const std::array key{int(animation), channel.sampler, componentsOf(channel.target_path)};
  const auto found = read.find(key);
  if (found != read.end()) return found->second;
  return read.emplace(key, readTrack(file, animation, channel, user)).first->second;
}

}  // namespace

std::string animationName(const std::vector<tinygltf::Animation>& animations, size_t i) {
  return animations[i].name.empty() ? fmt::format("{}", i) : animations[i].name;
}

std::string animationNames(const GltfFile& file) {
  std::vector<std::string> names;
  for (size_t i = 0; i < file.model.animations.size(); ++i)
    names.push_back(fmt::format("`{}`", animationName(file.model.animations, i)));
  return firstNames(names);
}

void applyAnimation(GltfFile& file, const AnimationTime& when) {
  const size_t index = findAnimation(file, when);
  const Animation& animation = file.model.animations[index];
  file.animated.assign(file.model.nodes.size(), false);
  for (size_t c = 0; c < animation.channels.size(); ++c) {
    const tinygltf::AnimationChannel& channel = animation.channels[c];
    const std::string where = fmt::format("animations[{}].channels[{}]", index, c);
    const std::string& path = channel.target_path;
    if (channel.target_node == -1 || componentsOf(path) == 0) {
      file.warnOnce(
          "ignored: animation channels that target neither a transform nor morph weights");
      continue;
    }
    tinygltf::Node& node =
        file.at(file.model.nodes, channel.target_node, "nodes", where + ".target");
    const bool isWeights = path == "weights";
    if (!node.matrix.empty() && !isWeights)
      file.fail(
          "{}: animates nodes[{}], which has a matrix; only nodes with translation, rotation "
          "and scale can be animated",
          where, channel.target_node);

    const Track& track = trackOf(file, index, channel, where);
    if (isWeights) checkWeights(file, node, track);
    std::vector<double>& target = isWeights          ? node.weights
                                  : track.isRotation ? node.rotation
                                  : path == "scale"  ? node.scale
                                                     : node.translation;
    file.animated[size_t(channel.target_node)] = true;
    target = valueAt(file, track, when.seconds);
  }
}

std::vector<double> changesAfter(GltfFile& file, const AnimationTime& when, double seconds) {
  const size_t index = findAnimation(file, when);
  std::set<double> changes;
  std::set<const Track*> seen;
  for (const tinygltf::AnimationChannel& channel : file.model.animations[index].channels) {
    if (channel.target_node == -1 || componentsOf(channel.target_path) == 0) continue;
    const Track& track = trackOf(file, index, channel, fmt::format("animations[{}]", index));
    if (!seen.insert(&track).second) continue;
    const std::vector<double> opening = valueAt(file, track, when.seconds);
    const auto addIfOther = [&](double time) {
      if (time > when.seconds && time < when.seconds + seconds &&
          areDifferent(valueAt(file, track, time), opening))
        changes.insert(time - when.seconds);
    };
    for (size_t i = 0; i < track.times.size(); ++i) {
      const double time = track.times[i];
      if (i > 0 && track.interpolation == Interpolation::CubicSpline)
        addIfOther(0.5 * (track.times[i - 1] + time));
      addIfOther(time);
    }
  }
  return {changes.begin(), changes.end()};
}

namespace {

// Adds the target's displacements to the first three components of `array`.
template <class Vector>
void addDisplacements(GltfFile& file, const std::map<std::string, int>& target, const char* name,
                      double weight, const std::string& where, std::vector<Vector>& array) {
  const auto found = target.find(name);
  if (found == target.end() || array.empty()) return;
  const std::string at = where + "." + name;
  const std::vector<vec3> displacements = readVectors<3>(file, found->second, at);
  if (displacements.size() != array.size())
    file.fail("{}: {} elements for {} vertices", at, displacements.size(), array.size());
  for (size_t i = 0; i < array.size(); ++i)
    for (int k = 0; k < 3; ++k) array[i][k] += float(weight) * displacements[i][k];
}

// Colours and texture coordinates may have displacements too (glTF 2.0, 3.7.2.2).
void warnOfUnmovedAttributes(GltfFile& file, const std::map<std::string, int>& target) {
  for (const auto& [name, accessor] : target)
    if (name.starts_with("COLOR_") || name.starts_with("TEXCOORD_"))
      file.warnOnce(fmt::format("ignored: {} of morph targets; it keeps its unmorphed values",
                                printableName(name)));
}

// The blended joint matrix of every vertex.
std::vector<glm::dmat4> blendJoints(GltfFile& file, const tinygltf::Primitive& primitive,
                                    std::span<const glm::dmat4> joints, const std::string& where,
                                    size_t vertexCount) {
  std::vector<glm::dmat4> blended(vertexCount, glm::dmat4(0));
  std::vector<double> sum(vertexCount, 0);
  for (int set = 0;; ++set) {
    const auto jointSet = primitive.attributes.find(fmt::format("JOINTS_{}", set));
    const auto weightSet = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
    if (jointSet == primitive.attributes.end() || weightSet == primitive.attributes.end()) break;
    const std::string jointsAt = fmt::format("{}.attributes.{}", where, jointSet->first);
    const std::vector<vec4> indices = readVectors<4>(file, jointSet->second, jointsAt);
    const std::vector<vec4> weights = readVectors<4>(
        file, weightSet->second, fmt::format("{}.attributes.{}", where, weightSet->first));
    if (indices.size() != vertexCount || weights.size() != vertexCount)
      file.fail("{}: {} joints and {} weights for {} vertices", jointsAt, indices.size(),
                weights.size(), vertexCount);
    for (size_t i = 0; i < vertexCount; ++i)
      for (int k = 0; k < 4; ++k) {
        const double weight = weights[i][k];
        if (!std::isfinite(weight))
          file.fail("{}: vertex {} has a weight that is not finite", jointsAt, i);
        if (weight == 0) continue;
        if (!(indices[i][k] >= 0 && indices[i][k] < float(joints.size())))
          file.fail("{}: joint {} out of range ({} joints)", jointsAt, indices[i][k],
                    joints.size());
        blended[i] += weight * joints[size_t(indices[i][k])];
        sum[i] += weight;
      }
  }
  // Normalise the weights, since quantised ones may not add up to 1. Vertices without weights
  // follow the first joint.
  for (size_t i = 0; i < vertexCount; ++i)
    blended[i] = std::fabs(sum[i]) > 1e-6 ? blended[i] / sum[i] : joints[0];
  return blended;
}

}  // namespace

void applyMorphTargets(GltfFile& file, const tinygltf::Primitive& primitive,
                       std::span<const double> weights, const std::string& where, Mesh& mesh) {
  for (size_t i = 0; i < std::min(primitive.targets.size(), weights.size()); ++i) {
    if (weights[i] == 0) continue;
    if (!std::isfinite(weights[i])) file.fail("{}: morph weight {} is not finite", where, i);
    const std::string target = fmt::format("{}.targets[{}]", where, i);
    warnOfUnmovedAttributes(file, primitive.targets[i]);
    addDisplacements(file, primitive.targets[i], "POSITION", weights[i], target, mesh.positions);
    addDisplacements(file, primitive.targets[i], "NORMAL", weights[i], target, mesh.normals);
    addDisplacements(file, primitive.targets[i], "TANGENT", weights[i], target, mesh.tangents);
  }
}

void applySkin(GltfFile& file, const tinygltf::Primitive& primitive,
               std::span<const glm::dmat4> joints, const std::string& where, Mesh& mesh) {
  const std::vector<glm::dmat4> blended =
      blendJoints(file, primitive, joints, where, mesh.positions.size());
  size_t mirrored = 0;
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dmat4& m = blended[i];
    const glm::dmat3 linear(m);
    const bool isMirrored = mirrors(linear);
    mirrored += isMirrored;
    mesh.positions[i] = vec3(m * glm::dvec4(glm::dvec3(mesh.positions[i]), 1));
    if (!mesh.normals.empty())
      mesh.normals[i] = vec3(normalMatrix(linear) * glm::dvec3(mesh.normals[i]));
    if (!mesh.tangents.empty()) {
      const vec4 t = mesh.tangents[i];
      mesh.tangents[i] = vec4(vec3(linear * glm::dvec3(t)), isMirrored ? -t.w : t.w);
    }
  }
  if (2 * mirrored > mesh.positions.size())
    for (Triangle& t : mesh.triangles) std::swap(t.y, t.z);
}

}  // namespace chromeball
