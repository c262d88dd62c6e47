// SPDX-License-Identifier: Apache-2.0
#include "bake/baked_file.h"

#include <fmt/format.h>

#include "bake/gltf_document.h"
#include "bake/vertex_light.h"

namespace chromeball {
namespace {

using Json = GltfDocument::Json;

template <class T>
std::vector<T> gathered(const std::vector<T>& ofMesh, const std::vector<uint32_t>& vertices) {
  std::vector<T> own;
  own.reserve(vertices.size());
  for (const uint32_t vertex : vertices) own.push_back(ofMesh[vertex]);
  return own;
}

class Writer {
 public:
  Writer(const Scene& scene, const std::vector<uint8_t>& page, const BakedFile& file,
         bool hasLightmap)
      : scene_(scene), file_(file), materials_(scene, document_, hasLightmap) {
    if (!page.empty()) page_ = materials_.addPage(page, "lightmap");
  }

  void add(const BakedGeometry& geometry) {
    if (geometry.triangles.empty()) return;
    const Instance& instance = scene_.instances[size_t(geometry.placed->instance)];
    const Json primitive = {{"attributes", attributesOf(geometry)},
                            {"indices", document_.indices(geometry.triangles)},
                            {"material", materialOf(instance.material)}};
    const int mesh = document_.add("meshes", {{"primitives", Json::array({primitive})}});
    addNode({{"name", scene_.nodeNames[size_t(instance.node)]}, {"mesh", mesh}});
  }

  void addCamera(const Camera& camera) {
    const vec3 &r = camera.right, &u = camera.up, &b = camera.back, &p = camera.position;
    const float aspect = camera.aspect > 0 ? camera.aspect : file_.aspect;
    constexpr float kNear = 0.01f, kFar = 1e4f;
    Json json;
    if (!camera.name.empty()) json["name"] = camera.name;
    json["type"] = camera.orthographic ? "orthographic" : "perspective";
    if (camera.orthographic)
      json["orthographic"] = {{"xmag", camera.halfHeight * aspect},
                              {"ymag", camera.halfHeight},
                              {"znear", kNear},
                              {"zfar", kFar}};
    else
      json["perspective"] = {{"yfov", camera.fov}, {"aspectRatio", aspect}, {"znear", kNear}};
    addNode({{"name", camera.node.empty() ? "camera" : camera.node},
             {"camera", document_.add("cameras", json)},
             {"matrix", {r.x, r.y, r.z, 0, u.x, u.y, u.z, 0, b.x, b.y, b.z, 0, p.x, p.y, p.z, 1}}});
  }

  void write(const std::filesystem::path& path) {
    const glm::dvec3& o = file_.origin;
    if (o != glm::dvec3(0)) {
      const int root = document_.add(
          "nodes", {{"name", "origin"}, {"translation", {o.x, o.y, o.z}}, {"children", nodes_}});
      nodes_ = Json::array({root});
    }
    document_.root["scene"] = 0;
    document_.root["scenes"] = Json::array({{{"nodes", nodes_}}});
    document_.root["extras"] = file_.extras;
    for (const NamedArray& table : file_.tables)
      document_.root["extras"]["chromeball"]["tables"][table.name] =
          document_.accessor(table.elements);
    document_.write(path);
  }

 private:
  void addNode(Json node) { nodes_.push_back(document_.add("nodes", std::move(node))); }

  Json attributesOf(const BakedGeometry& geometry) {
    const PlacedMesh& placed = *geometry.placed;
    const std::vector<uint32_t>& vertices = geometry.vertices;
    Json attributes;
    std::vector<vec3> positions;
    for (const uint32_t vertex : vertices) positions.emplace_back(placed.positions[vertex]);
    attributes["POSITION"] = document_.accessor(positions);
    if (!placed.shadingNormals.empty()) addNormals(geometry, attributes);
    if (file_.look != BakedLook::Unlit && !placed.tangents.empty() &&
        !placed.shadingNormals.empty())
      attributes["TANGENT"] = document_.accessor(gathered(placed.tangents, vertices));
    addUvs(geometry, attributes);
    if (!geometry.colors.empty())
      attributes["COLOR_0"] = document_.accessor(scaled(geometry.colors));
    else if (!placed.mesh->colors.empty() && !isShownWhole(geometry))
      attributes["COLOR_0"] = document_.accessor(gathered(placed.mesh->colors, vertices));
    if (!geometry.light.empty()) {
      const char* names[] = {"_IRRADIANCE", "_OCCLUSION", "_RADIANCE"};
      attributes[names[int(file_.what)]] = document_.accessor(geometry.light);
    }
    for (const NamedArray& more : geometry.attributes)
      attributes[more.name] = document_.accessor(more.elements);
    return attributes;
  }

  // glTF demands unit normals; a degenerate vertex gets an arbitrary one.
  void addNormals(const BakedGeometry& geometry, Json& attributes) {
    std::vector<vec3> normals = gathered(geometry.placed->shadingNormals, geometry.vertices);
    for (vec3& n : normals)
      if (n == vec3(0)) n = vec3(0, 1, 0);
    attributes["NORMAL"] = document_.accessor(normals);
  }

  // UV sets that the mesh lacks, but that glTF requires before others, are the lightmap's or 0.
  void addUvs(const BakedGeometry& geometry, Json& attributes) {
    std::vector<int> sets;
    const auto zeros = [&] {
      return document_.accessor(std::vector<vec2>(geometry.vertices.size(), vec2(0)));
    };
    if (!isShownWhole(geometry))
      for (const std::vector<vec2>& set : geometry.placed->mesh->uvs)
        sets.push_back(set.empty() ? zeros()
                                   : document_.accessor(gathered(set, geometry.vertices)));
    if (!geometry.lightmapUv.empty()) {
      const int map = document_.accessor(geometry.lightmapUv);
      if (sets.empty()) sets.push_back(map);
      sets.insert(sets.begin() + kLightmapSet, map);
    }
    if (sets.size() > size_t(kMaxUvSet) + 1)
      throwInput("the model uses TEXCOORD_{}, and the lightmap needs a set besides; the most is {}",
                 sets.size() - 2, kMaxUvSet);
    for (size_t i = 0; i < sets.size(); ++i) attributes[fmt::format("TEXCOORD_{}", i)] = sets[i];
  }

  // Whether the lightmap or the colours of vertices alone show the light, without textures of the
  // model.
  bool isShownWhole(const BakedGeometry& geometry) const {
    if (file_.look != BakedLook::Unlit) return false;
    const Instance& instance = scene_.instances[size_t(geometry.placed->instance)];
    return page_ >= 0 || showsWhole(file_.what, scene_.materials[size_t(instance.material)]);
  }

  std::vector<vec4> scaled(std::vector<vec4> colors) const {
    for (vec4& c : colors) c = glm::clamp(vec4(vec3(c) / file_.scale, c.w), 0.0f, 1.0f);
    return colors;
  }

  int materialOf(int index) {
    const auto [found, isNew] = numbers_.try_emplace(index, 0);
    if (!isNew) return found->second;
    const Material& m = scene_.materials[size_t(index)];
    Json json = file_.look != BakedLook::Unlit ? materials_.lit(m)
                : page_ >= 0                   ? materials_.lightmapped(m, page_)
                : showsWhole(file_.what, m)    ? materials_.coloured(m)
                                               : materials_.unlit(m);
    if (file_.look == BakedLook::Occluded && page_ >= 0 && !m.unlit)
      json["occlusionTexture"] = {{"index", page_}, {"texCoord", kLightmapSet}};
    if (file_.look == BakedLook::Unlit) json["extras"] = {{"scale", file_.scale}};
    return found->second = document_.add("materials", std::move(json));
  }

  const Scene& scene_;
  const BakedFile& file_;
  GltfDocument document_;
  GltfMaterials materials_;
  int page_ = -1;               // the lightmap's texture
  std::map<int, int> numbers_;  // of materials, by index in the scene
  Json nodes_ = Json::array();
};

}  // namespace

std::vector<uint8_t> pageOf(const Lightmap& map, const BakedFile& file) {
  if (file.look == BakedLook::Lit) return {};
  if (file.look == BakedLook::Occluded) return pngOf(map.light, false);
  Image shown = map.shown;
  for (size_t i = 0; i < shown.texels.size(); ++i)
    if (i % 4 != 3) shown.texels[i] /= file.scale;
  return pngOf(shown, true);
}

void writeBaked(const std::filesystem::path& path, const Scene& scene,
                const std::vector<BakedGeometry>& geometry, const std::vector<uint8_t>& page,
                const BakedFile& file) {
  const bool hasLightmap =
      std::ranges::any_of(geometry, [](const BakedGeometry& g) { return !g.lightmapUv.empty(); });
  Writer writer(scene, page, file, hasLightmap);
  for (const BakedGeometry& g : geometry) writer.add(g);
  if (file.camera) writer.addCamera(*file.camera);
  writer.write(path);
}

}  // namespace chromeball
