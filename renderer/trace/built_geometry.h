// SPDX-License-Identifier: Apache-2.0
// Embree's structures over single meshes and over instances that do not move. The acceleration
// structures of several frames share them.
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "scene/scene.h"
#include "trace/ray.h"

struct RTCDeviceTy;
struct RTCGeometryTy;
struct RTCSceneTy;

namespace chromeball {

// Which hits call the filter functions (trace/filter.h).
struct FilterUse {
  std::vector<bool> ofMesh;  // by mesh: whether any instance lets light pass
  // Properties of the whole scene.
  bool any = false, hasAlpha = false, needsMedia = false;
};

class BuiltGeometry {
 public:
  // Filter functions refer to `scene`, which may change between builds but not move. Throws
  // RunError if Embree cannot start.
  explicit BuiltGeometry(const Scene& scene);
  ~BuiltGeometry();
  BuiltGeometry(const BuiltGeometry&) = delete;
  BuiltGeometry& operator=(const BuiltGeometry&) = delete;

  const Scene& scene() const { return scene_; }
  RTCDeviceTy* device() const { return device_; }
  int builds() const { return builds_; }  // so far, of meshes and of the instances that do not move

  // Begins a build: keeps the structures of an earlier one for meshes that the scene still has.
  void begin(FilterUse filters);

  RTCSceneTy* newScene() const;
  RTCGeometryTy* newGeometry(int mesh) const;
  // Geometry in world space for an instance that changes its shape while the shutter is open.
  RTCGeometryTy* newMovingGeometry(const Instance& instance) const;
  RTCSceneTy* meshScene(int mesh);
  // A scene of instances whose meshes are stored in world space. `mask`: by instance; empty: all.
  RTCSceneTy* staticScene(const std::vector<uint32_t>& instances, const std::vector<RayMask>& mask);

  // Adds the geometry, which it takes, to the scene.
  static void attach(RTCSceneTy* scene, RTCGeometryTy* geometry, uint32_t id, RayMask mask);
  // Builds the structure. Throws Interrupted (base/progress.h).
  static void commit(RTCSceneTy* scene);

 private:
  struct MeshScene {
    MeshList::Shared mesh;  // the structure refers to its triangles
    RTCSceneTy* scene = nullptr;
  };
  struct Member {
    uint32_t instance;
    MeshList::Shared mesh;
    bool hasFilter;
    RayMask mask;
    bool operator==(const Member&) const = default;
  };
  void releaseStatic();
  // Triangles without vertices.
  RTCGeometryTy* newTriangles(int mesh) const;

  const Scene& scene_;
  RTCDeviceTy* device_;
  FilterUse filters_;
  std::map<std::pair<const Mesh*, bool>, MeshScene> meshScenes_;  // by mesh and FilterUse::ofMesh
  std::vector<Member> members_;                                   // of the static scene
  RTCSceneTy* static_ = nullptr;
  int builds_ = 0;
};

}  // namespace chromeball
