// SPDX-License-Identifier: Apache-2.0
#include "session/memory_estimate.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "composite/render_composite.h"
#include "denoise/denoise.h"
#include "image/io/texel_file.h"
#include "lighting/emitters.h"

namespace chromeball {
namespace {

// Embree's bytes for a triangle, with its copy of the vertices; measured with grids of two
// triangles per vertex, the ratio of closed surfaces.
constexpr double kBuiltTriangle = 84, kBuildingTriangle = 116;
// Bytes for a texel: radiance as read and in the probe; the cumulative distribution.
constexpr double kProbeTexel = 3 * sizeof(float), kTableTexel = sizeof(double);

double triangleCountOfMeshes(const Scene& scene) {
  double count = 0;
  for (const Mesh& mesh : scene.meshes) count += double(mesh.triangles.size());
  for (const Instance& instance : scene.instances)
    if (instance.motion && !instance.motion->isRigid())
      count += double(scene.meshes[size_t(instance.mesh)].triangles.size()) *
               double(instance.motion->keys.size() - 1);
  return count;
}

// Of emissive triangles as lights (lighting/emitters.h), at their places.
double emitterBytes(const Scene& scene) {
  double count = 0;
  for (const Instance& instance : scene.instances) {
    const Material& material = scene.materials[size_t(instance.material)];
    if (material.emits() && !material.unlit)
      count += double(scene.meshes[size_t(instance.mesh)].triangles.size());
  }
  return double(Emitters::kBytesPerTriangle) * count;
}

double bytesOfFiles(const Scene& scene) {
  double bytes = 0;
  for (const std::string& path : scene.files) {
    std::error_code unreadable;
    const auto size = std::filesystem::file_size(path, unreadable);
    if (!unreadable) bytes += double(size);
  }
  return bytes;
}

// Bytes for a pixel.
struct PixelMemory {
  double film = double(Film::bytesPerPixel());  // all sums of samples
  double texels = 4 * sizeof(float);            // of the output: the colour and the layers
};

PixelMemory pixelMemory(const RenderSettings& settings) {
  PixelMemory m;
  if (!settings.aovs.empty()) m.film += 2 * sizeof(uint32_t);
  if (settings.wantsFeatures()) m.film += double(FeatureFilm::bytesPerPixel());
  for (Aov aov : settings.aovs) {
    const double channels = aov == Aov::Denoise
                                ? FeatureFilm::kLayerChannels
                                : std::max<double>(1, double(std::strlen(aovInfo(aov).channels)));
    if (aov != Aov::Denoise) m.film += channels * sizeof(double);  // made of the features
    m.texels += channels * sizeof(float);
  }
  return m;
}

double pixelsOf(const RenderSettings& settings) {
  return double(settings.window().width) * settings.window().height;
}

// The additional memory for snapshots of a session (live_image.h): three images; for a composite, a
// copy of the film and two images.
double snapshotBytes(const RenderSettings& settings, bool isComposite) {
  const PixelMemory pixel = pixelMemory(settings);
  return pixelsOf(settings) * ((isComposite ? pixel.film : pixel.texels) + 2 * pixel.texels);
}

}  // namespace

double imageBytes(const RenderDescription& description) {
  if (!description.run.makesImage) return 0;
  const RenderSettings& s = description.settings;
  const double composite = description.composite ? double(compositeBytesPerPixel(s.denoise)) : 0;
  const double snapshots =
      description.run.isWatched ? snapshotBytes(s, description.composite.has_value()) : 0;
  return imageBytes(s) + snapshots + composite * s.width * s.height;
}

double geometryBytes(const Scene& scene) {
  return double(scene.byteCount() - scene.texelByteCount()) +
         kBuiltTriangle * triangleCountOfMeshes(scene);
}

double memoryLimit(const RenderDescription& description) {
  return description.run.memory.value_or(memoryBudget());
}

MemoryEstimate estimateMemory(const LoadedScene& loaded) {
  const RenderDescription& description = loaded.description;
  const Scene& scene = loaded.scene;
  const double texels = double(scene.texelByteCount());
  const double meshes = double(scene.byteCount()) - texels;
  const double triangles = triangleCountOfMeshes(scene);
  const double mapTexels = double(loaded.probe.width()) * loaded.probe.height();
  const double fileTexels = double(loaded.loadedProbe.fileWidth) * loaded.loadedProbe.fileHeight;
  const double map = kProbeTexel * mapTexels;

  MemoryEstimate e;
  e.process = kProcessBytes;
  e.images = imageBytes(description);
  e.textures = texels;
  if (const auto& file = scene.texelFile)
    e.textures += double(std::min(file->byteCount(), file->cacheBytes()));
  const bool keepsFiles = description.run.isOfFrames && scene.isAnimated;
  const double emitters = emitterBytes(scene);
  e.geometry = geometryBytes(scene) + emitters + (keepsFiles ? bytesOfFiles(scene) : 0);
  e.probe = map + kTableTexel * mapTexels;

  const double always = e.process + e.textures + meshes;
  const double readingModels = always + bytesOfFiles(scene);
  const double readingProbe = always + map + kProbeTexel * std::max(mapTexels, fileTexels);
  const double building = always + map + kBuildingTriangle * triangles;
  const double rendering = e.process + e.textures + e.geometry + e.probe + e.images;
  e.peak = std::max({readingModels, readingProbe, building, rendering});
  return e;
}

std::string inWords(const MemoryEstimate& e) {
  return fmt::format("images {:.2g} GB, textures {:.2g} GB, geometry {:.2g} GB, probe {:.2g} GB",
                     1e-9 * e.images, 1e-9 * e.textures, 1e-9 * e.geometry, 1e-9 * e.probe);
}

void checkMemory(const LoadedScene& loaded) {
  const MemoryEstimate estimate = estimateMemory(loaded);
  checkMemory(loaded.description, estimate.peak, "{}: takes {:.3g} GB of memory ({})",
              loaded.description.path, 1e-9 * estimate.peak, inWords(estimate));
}

double imageBytes(const RenderSettings& settings) {
  const PixelMemory pixel = pixelMemory(settings);
  // Estimating the noise takes three fields of errors, two of luminances and the variance; later
  // the layers and the texels of the file exist together.
  constexpr double kNoise = 3 * sizeof(glm::dvec4) + 2 * sizeof(double) + 3 * sizeof(float);
  constexpr int kMaxParts = 3;  // the most that denoise() gets: a composite's
  const Crop window = settings.window();
  const double denoising =
      settings.denoise ? denoiseBytes(window.width, window.height, kMaxParts) : 0;
  return pixelsOf(settings) * (pixel.film + std::max(kNoise, 2 * pixel.texels)) + denoising;
}

}  // namespace chromeball
