// SPDX-License-Identifier: Apache-2.0
// States the memory that a loaded scene's render will take, before the acceleration structure, the
// tables of the probe and the images are allocated.
#pragma once

#include "base/error.h"
#include "base/memory.h"
#include "render/render.h"
#include "session/load_scene.h"

namespace chromeball {

// Bytes.
struct MemoryEstimate {
  double process = 0;   // the program, its libraries and its fixed tables
  double images = 0;    // film, layers and output
  double textures = 0;  // texels in memory, or the cache of texels in a file
  double geometry = 0;  // vertices, triangles and the acceleration structure
  double probe = 0;     // radiance and the tables to sample it
  double peak = 0;      // the most at any one time; files are freed before images are allocated
};

MemoryEstimate estimateMemory(const LoadedScene& loaded);

// The description's limit: `--memory`, or memoryBudget().
double memoryLimit(const RenderDescription& description);

// Throws InputError "WHAT; the limit is X GB" if so many bytes exceed the limit; `format` says
// what.
template <class... Args>
void checkMemory(const RenderDescription& description, double bytes,
                 fmt::format_string<Args...> format, Args&&... args) {
  const double limit = memoryLimit(description);
  if (bytes > limit)
    throw InputError(fmt::format("{}; the limit is {:.3g} GB",
                                 fmt::format(format, std::forward<Args>(args)...), 1e-9 * limit),
                     Remedy{"memory", {}});
}

// The film, layers, output images and snapshots of a description of known size.
double imageBytes(const RenderDescription& description);

// Meshes and Embree's structure over them.
double geometryBytes(const Scene& scene);

// "images 1.2 GB, textures 0.1 GB, ..."
std::string inWords(const MemoryEstimate& estimate);

// Throws InputError if the peak exceeds the limit.
void checkMemory(const LoadedScene& loaded);

// Estimates the memory of a render before it is allocated.

// The program, its libraries and its fixed tables; measured.
inline constexpr double kProcessBytes = 3e7;

// Peak memory of the film, the layers and the output images, in bytes.
double imageBytes(const RenderSettings& settings);

}  // namespace chromeball
