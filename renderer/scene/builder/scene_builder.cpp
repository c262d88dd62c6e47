// SPDX-License-Identifier: Apache-2.0
#include "scene/builder/scene_builder.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "math/vec.h"
#include "scene/builder/complete_mesh.h"
#include "scene/motion.h"
#include "scene/texture.h"

namespace chromeball {
namespace {

void checkIndex(const char* what, int index, size_t count) {
  if (index < 0 || size_t(index) >= count)
    throwInput("there is no {} {} among {}", what, index, count);
}

template <class... Numbers>
bool areAllFinite(const Numbers&... numbers) {
  return (std::isfinite(numbers) && ...);
}

void checkRadiance(const char* what, const std::string& name, const Rgb& color) {
  if (!isFinite(color) || glm::any(glm::lessThan(color, Rgb(0))))
    throwInput("{} \"{}\": its light must be finite, and not negative", what, name);
}

void checkDirection(const char* what, const std::string& name, const vec3& direction) {
  constexpr float kTolerance = 1e-3f;
  if (!(std::fabs(glm::length(direction) - 1) < kTolerance))
    throwInput("{} \"{}\": its direction must be a unit vector", what, name);
}

void checkTexels(const TexelGrid& image) {
  const size_t texels = size_t(image.width) * size_t(image.height);
  if (image.width < 1 || image.height < 1)
    throwInput("image: is {} x {}; it must have a texel", image.width, image.height);
  if (!image.texels8.empty() == !image.texelsFloat.empty() ||
      image.texels8.size() + image.texelsFloat.size() != texels)
    throwInput("image: {} texels of 8 bits and {} of floats, for {} x {}", image.texels8.size(),
               image.texelsFloat.size(), image.width, image.height);
  for (size_t i = 0; i < image.texelsFloat.size(); ++i) {
    const vec4& t = image.texelsFloat[i];
    if (!areAllFinite(t.x, t.y, t.z, t.w) || glm::any(glm::lessThan(t, vec4(0))))
      throwInput("image: texel {}, {} must be finite, and not negative", i % size_t(image.width),
                 i / size_t(image.width));
  }
}

// The ranges of a material's numbers (glTF 2.0 and its extensions).

constexpr float kMostOfOthers = 1e6f, kMostFloat = std::numeric_limits<float>::max();

class MaterialCheck {
 public:
  explicit MaterialCheck(const Material& material) : material_(material) {}

  void number(const char* name, float x, float low, float high) const {
    if (!(x >= low && x <= high))
      throwInput("material \"{}\": {} is {:g}; it must be {:g} to {:g}", material_.name, name, x,
                 low, high);
  }
  void color(const char* name, const Rgb& c, float high) const {
    for (int k = 0; k < 3; ++k) number(name, c[k], 0, high);
  }

 private:
  const Material& material_;
};

void checkExtended(const MaterialCheck& check, const ExtendedMaterial& m) {
  check.number("transmission", m.transmission, 0, 1);
  check.color("attenuation", m.attenuation, kMostFloat);
  check.number("dispersion", m.dispersion, 0, 1e3f);
  check.number("clearcoat", m.clearcoat, 0, 1);
  check.number("clearcoatRoughness", m.clearcoatRoughness, 0, 1);
  check.number("clearcoatNormalScale", m.clearcoatNormalScale, -kMostOfOthers, kMostOfOthers);
  check.color("sheenColor", m.sheenColor, 1);
  check.number("sheenRoughness", m.sheenRoughness, 0, 1);
  check.number("anisotropy", m.anisotropy, 0, 1);
  check.number("anisotropyRotation", m.anisotropyRotation, -kMostOfOthers, kMostOfOthers);
  check.number("iridescence", m.iridescence, 0, 1);
  check.number("filmIor", m.filmIor, 1, 1e3f);
  check.number("filmMinThickness", m.filmMinThickness, 0, kMostOfOthers);
  check.number("filmMaxThickness", m.filmMaxThickness, 0, kMostOfOthers);
}

void checkSlots(const Material& material, size_t textures) {
  Material copy = material;  // textureSlots() allows changes
  for (const TextureSlot* slot : textureSlots(copy)) {
    if (!*slot) continue;
    if (size_t(slot->texture) >= textures)
      throwInput("material \"{}\": there is no texture {} among {}", material.name, slot->texture,
                 textures);
    if (slot->uvSet < 0 || slot->uvSet > kMaxUvSet)
      throwInput("material \"{}\": uvSet {} of a texture must be 0 to {}", material.name,
                 slot->uvSet, kMaxUvSet);
    for (const vec2& v : {slot->uvRow0, slot->uvRow1, slot->uvOffset})
      if (!std::isfinite(v.x + v.y))
        throwInput("material \"{}\": the transform of a texture is not finite", material.name);
  }
}

// `textures`: how many there are.
void checkMaterial(const Material& m, size_t textures) {
  const MaterialCheck check(m);
  check.color("baseColor", Rgb(m.baseColor), 1);
  check.number("alpha of baseColor", m.baseColor.w, 0, 1);
  check.number("metallic", m.metallic, 0, 1);
  check.number("roughness", m.roughness, 0, 1);
  check.color("emission", m.emission, kMostFloat);
  if (m.ior != 0) check.number("ior", m.ior, 1, kMostOfOthers);
  check.number("specular", m.specular, 0, 1);
  check.color("specularColor", m.specularColor, kMostFloat);
  check.number("normalScale", m.normalScale, -kMostOfOthers, kMostOfOthers);
  check.number("alphaCutoff", m.alphaCutoff, 0, kMostOfOthers);
  if (m.extended) checkExtended(check, *m.extended);
  checkSlots(m, textures);
}

// Floats may exceed 1 where they are light, or a colour that has no upper limit itself.
void checkTexelsOf(const Material& material, const std::vector<Texture>& textures) {
  Material copy = material;
  for (const TextureSlot* slot : textureSlots(copy)) {
    if (!*slot || slot == &copy.emissiveTexture || slot == &copy.specularColorTexture) continue;
    const TexelGrid& grid = *textures[size_t(slot->texture)].grid;
    for (size_t i = 0; i < grid.texelsFloat.size(); ++i)
      if (glm::any(glm::greaterThan(grid.texelsFloat[i], vec4(1))))
        throwInput(
            "material \"{}\": texel {}, {} of a texture exceeds 1, as only emission and the "
            "specular colour may",
            material.name, i % size_t(grid.width), i / size_t(grid.width));
  }
}

}  // namespace

int SceneBuilder::addNode(std::string name, int parent) {
  std::vector<int>& parents = scene_.nodeParents;
  if (parent != -1) {
    checkIndex("node", parent, scene_.nodeNames.size());
    parents.resize(scene_.nodeNames.size(), -1);
  }
  if (parent != -1 || !parents.empty()) parents.push_back(parent);
  scene_.nodeNames.push_back(std::move(name));
  return int(scene_.nodeNames.size()) - 1;
}

int SceneBuilder::addImage(TexelGrid image) {
  checkTexels(image);
  scene_.grids.push_back(std::make_shared<TexelGrid>(std::move(image)));
  return int(scene_.grids.size()) - 1;
}

int SceneBuilder::addTexture(Texture texture) {
  MipChain& chain = chains_[{texture.grid, texture.srgb, texture.weightedByAlpha}];
  if (!chain)
    chain = std::make_shared<const std::vector<TexelGrid>>(
        makeMipLevels(*texture.grid, texture.srgb, texture.weightedByAlpha));
  texture.mipLevels = chain;
  scene_.textures.push_back(std::move(texture));
  return int(scene_.textures.size()) - 1;
}

TextureSlot SceneBuilder::addTexture(int image, bool srgb, const TextureSampler& sampler) {
  checkIndex("image", image, scene_.grids.size());
  Texture texture;
  texture.grid = scene_.grids[size_t(image)].get();
  texture.wrapS = sampler.wrapS;
  texture.wrapT = sampler.wrapT;
  texture.filter = sampler.filter;
  texture.srgb = srgb;
  TextureSlot slot;
  slot.texture = addTexture(std::move(texture));
  return slot;
}

int SceneBuilder::addMaterial(Material material) {
  checkMaterial(material, scene_.textures.size());
  checkTexelsOf(material, scene_.textures);
  TextureSlot& color = material.baseColorTexture;
  if (color && material.alphaMode != AlphaMode::Opaque &&
      !scene_.textures[size_t(color.texture)].weightedByAlpha) {
    Texture weighted = scene_.textures[size_t(color.texture)];
    weighted.weightedByAlpha = true;
    color.texture = addTexture(std::move(weighted));
  }
  scene_.materials.push_back(std::move(material));
  return int(scene_.materials.size()) - 1;
}

int SceneBuilder::addMesh(Mesh mesh, int material) {
  checkIndex("material", material, scene_.materials.size());
  const Material& needs = scene_.materials[size_t(material)];
  const std::string location = fmt::format("mesh {}: ", scene_.meshes.size());
  if (mesh.triangles.empty()) {
    if (mesh.positions.size() % 3 != 0)
      throwInput("{}positions: {}; without triangles their number must be a multiple of 3",
                 location, mesh.positions.size());
    for (uint32_t i = 0; i < mesh.positions.size(); i += 3)
      mesh.triangles.push_back({i, i + 1, i + 2});
  }
  checkMesh(mesh, needs, location);
  completeMesh(mesh, needs);
  scene_.meshes.push_back(std::move(mesh));
  return int(scene_.meshes.size()) - 1;
}

int SceneBuilder::addMesh(MeshList::Shared mesh) {
  const std::string location = fmt::format("mesh {}: ", scene_.meshes.size());
  if (!mesh) throwInput("{}is null", location);
  checkShape(*mesh, location);
  scene_.meshes.push_back(std::move(mesh));
  return int(scene_.meshes.size()) - 1;
}

void SceneBuilder::addInstance(int mesh, int material, int node,
                               const std::optional<Transform>& toWorld, bool moves) {
  checkIndex("mesh", mesh, scene_.meshes.size());
  checkIndex("material", material, scene_.materials.size());
  checkIndex("node", node, scene_.nodeNames.size());
  if (toWorld &&
      (!canPlaceInstance(glm::dmat3(toWorld->linear)) || !isFinite(toWorld->translation)))
    throwInput(
        "instance {} (\"{}\"): its transform is not invertible, beyond the range of float, or "
        "scales by more than {:g} or less than {:g}; transform its vertices",
        scene_.instances.size(), scene_.nodeNames[size_t(node)], kMostInstanceScale,
        1 / kMostInstanceScale);
  scene_.instances.push_back(
      {.mesh = mesh, .material = material, .node = node, .toWorld = toWorld, .moves = moves});
}

void SceneBuilder::addInstance(int mesh, int material, int node, const glm::dmat4& toWorld) {
  const glm::dvec3 translation(toWorld[3]);
  addInstance(mesh, material, node, Transform{glm::mat3(glm::dmat3(toWorld)), vec3(translation)});
  scene_.instances.back().translationRest = floatRest(translation);
}

int SceneBuilder::addCamera(Camera camera) {
  const bool hasView = camera.orthographic ? camera.halfHeight > 0 : camera.fov > 0;
  if (!hasView || !isFinite(camera.position) || !areAllFinite(camera.fov, camera.halfHeight) ||
      (!camera.orthographic && !(camera.fov < kPi)))
    throwInput(
        "camera \"{}\": its position and field of view must be finite, and the latter above 0",
        camera.name);
  for (const vec3& axis : {camera.right, camera.up, camera.back})
    checkDirection("camera", camera.name, axis);
  scene_.cameras.push_back(std::move(camera));
  return int(scene_.cameras.size()) - 1;
}

void SceneBuilder::addLight(const PunctualLight& light) {
  checkRadiance("light", light.name, light.intensity);
  checkDirection("light", light.name, light.direction);
  if (!isFinite(light.position) || !(light.range > 0))
    throwInput("light \"{}\": its position must be finite, and its range above 0", light.name);
  const bool isSpot = light.kind == PunctualLight::Kind::Spot;
  if (isSpot &&
      !(light.innerCone >= 0 && light.innerCone <= light.outerCone && light.outerCone <= 2))
    throwInput("light \"{}\": its cones must be from 0 to 2, the inner one within the outer",
               light.name);
  if (light.node != -1) checkIndex("node", light.node, scene_.nodeNames.size());
  scene_.lights.push_back(light);
}

void SceneBuilder::addSun(const SunLamp& lamp) {
  constexpr double kMostDegrees = 90;
  checkRadiance("sun", lamp.name, Rgb(lamp.sun.irradiance));
  checkDirection("sun", lamp.name, vec3(lamp.sun.direction));
  if (!(lamp.sun.angle > 0 && lamp.sun.angle <= kMostDegrees))
    throwInput("sun \"{}\": its diameter must be above 0 and at most {} degrees", lamp.name,
               kMostDegrees);
  scene_.suns.push_back(lamp);
}

void SceneBuilder::addAmbient(const AmbientLamp& light) {
  checkRadiance("ambient light", light.name, light.radiance);
  scene_.ambient.push_back(light);
}

namespace {

// A polygon whose front side (corners counter-clockwise) emits.
Mesh polygonOf(const DiscLamp& disc, const vec3& centre) {
  const double turn = 2 * kPiD / kDiscSides;
  const double circumradius = disc.radius * std::sqrt(turn / std::sin(turn));  // of equal area
  const Frame frame(disc.direction);
  Mesh mesh;
  mesh.positions.push_back(centre);
  for (uint32_t i = 0; i < kDiscSides; ++i) {
    const double angle = turn * i;
    mesh.positions.push_back(centre +
                             frame.toWorld(vec3(float(circumradius * std::cos(angle)),
                                                float(circumradius * std::sin(angle)), 0)));
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % kDiscSides});
  }
  return mesh;
}

Material emitter(const DiscLamp& disc, const std::string& name) {
  Material m;
  m.name = name;
  m.baseColor = vec4(0, 0, 0, 1);
  m.metallic = m.specular = 0;
  m.emission = disc.radiance;
  return m;
}

}  // namespace

void addLamp(Scene& scene, const Lamp& lamp, const glm::dvec3& origin) {
  SceneBuilder builder(scene);
  if (lamp.sun) return builder.addSun(*lamp.sun);
  if (lamp.ambient) return builder.addAmbient(*lamp.ambient);
  const vec3 position(lamp.position - origin);
  if (lamp.punctual) {
    PunctualLight light = *lamp.punctual;
    light.position = position;
    return builder.addLight(light);
  }
  const int material = builder.addMaterial(emitter(*lamp.disc, lamp.name));
  builder.addInstance(builder.addMesh(polygonOf(*lamp.disc, position), material), material,
                      builder.addNode(lamp.name));
}

}  // namespace chromeball
