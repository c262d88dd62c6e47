// SPDX-License-Identifier: Apache-2.0
#include "probe/cube_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr int kFaces = 6, kPz = 4, kNz = 5;

struct FaceNames {
  std::array<std::string_view, kFaces> names;  // of +X -X +Y -Y +Z -Z
  bool areAxes;
};

constexpr FaceNames kNames[] = {
    {{"px", "nx", "py", "ny", "pz", "nz"}, true},
    {{"posx", "negx", "posy", "negy", "posz", "negz"}, true},
    {{"right", "left", "top", "bottom", "back", "front"}, false},
};

struct FaceName {
  std::string prefix;
  const FaceNames* names;
  auto operator<=>(const FaceName&) const = default;
};

// The files of each face of a cube map, none or several of them.
using FaceFiles = std::array<std::vector<fs::path>, kFaces>;

bool hasImageName(const fs::path& file) {
  constexpr std::string_view kExtensions[] = {".exr",  ".hdr",  ".pfm", ".png", ".jpg",
                                              ".jpeg", ".webp", ".tif", ".tiff"};
  return !file.filename().string().starts_with('.') &&
         std::ranges::count(kExtensions, lowerExtension(file)) > 0;
}

// Calls found(name, face) if the file has the name of a face.
template <class Found>
void findFaceName(const fs::path& file, const Found& found) {
  if (!hasImageName(file)) return;
  const std::string stem = lowerCase(file.stem().string());
  for (const FaceNames& names : kNames)
    for (size_t face = 0; face < kFaces; ++face) {
      if (!stem.ends_with(names.names[face])) continue;
      const std::string prefix = stem.substr(0, stem.size() - names.names[face].size());
      if (prefix.empty() || std::string_view("_-. ").find(prefix.back()) != std::string::npos)
        found(FaceName{prefix, &names}, face);
    }
}

std::map<FaceName, FaceFiles> cubesIn(const fs::path& folder) {
  std::map<FaceName, FaceFiles> cubes;
  for (const auto& entry : fs::directory_iterator(folder))
    findFaceName(entry.path(), [&](const FaceName& name, size_t face) {
      cubes[name][face].push_back(entry.path());
    });
  return cubes;
}

size_t countOf(const FaceFiles& cube) {
  return kFaces - size_t(std::ranges::count_if(cube, [](const auto& f) { return f.empty(); }));
}

[[noreturn]] void refuseIncomplete(const fs::path& folder,
                                   const std::map<FaceName, FaceFiles>& cubes) {
  const auto fullest =
      std::ranges::max_element(cubes, {}, [](const auto& cube) { return countOf(cube.second); });
  if (fullest == cubes.end())
    throwInput(
        "{}: is a folder without a cube map, whose faces would be images named px, nx, py, ny, pz, "
        "nz; posx, negx, ...; or right, left, top, bottom, front, back",
        folder.string());
  std::vector<std::string> missing;
  for (size_t face = 0; face < kFaces; ++face)
    if (fullest->second[face].empty())
      missing.push_back(fullest->first.prefix + std::string(fullest->first.names->names[face]));
  throwInput("{}: its cube map has no file {}", folder.string(),
             printable(fmt::format("{}", fmt::join(missing, ", "))));
}

float lightAt(const Image& image, int x, int y) {
  return maxComponent(glm::max(image.rgb(x, y), Rgb(0)));
}

// How much the columns differ where four faces of a strip meet, each of which is to the right of
// the one before it: the mean of |a - b| / (a + b).
double seamError(const Image& strip, const std::array<int, 4>& ring) {
  const int n = strip.height;
  double sum = 0;
  for (size_t i = 0; i < ring.size(); ++i)
    for (int y = 0; y < n; ++y) {
      const double a = lightAt(strip, ring[i] * n + n - 1, y),
                   b = lightAt(strip, ring[(i + 1) % ring.size()] * n, y);
      if (a + b > 0 && std::isfinite(a + b)) sum += std::fabs(a - b) / (a + b);
    }
  return sum / (4 * n);
}

void swapFaces(Image& strip, int a, int b) {
  const int n = strip.height;
  for (int y = 0; y < n; ++y)
    std::swap_ranges(strip.at(a * n, y), strip.at(a * n, y) + n * strip.channels,
                     strip.at(b * n, y));
}

// Puts the faces of a graphics API, in which pz is the front, where OpenEXR's names of the axes
// would have them. Most programs that write six files are such.
void orientAxes(const fs::path& folder, ImageFile& file) {
  constexpr double kBetter = 0.99;  // else faces of one colour would be decided by rounding
  const double openGl = seamError(file.image, {0, kNz, 1, kPz}),
               openExr = seamError(file.image, {0, kPz, 1, kNz});
  const bool isOpenExr = openExr < kBetter * openGl;
  if (!isOpenExr) swapFaces(file.image, kPz, kNz);
  const bool isKnown = isOpenExr || openGl < kBetter * openExr;
  addNote(file.messages, "{}: read as a cube map, the face pz as {}", folder.string(),
          isOpenExr ? "+Z: the edges fit as in OpenEXR"
          : isKnown
              ? "its front, -Z: the edges fit as in OpenGL and Direct3D"
              : "its front, -Z, as in OpenGL and Direct3D: the edges do not tell; files named "
                "right, left, top, bottom, front, back leave no doubt");
}

}  // namespace

CubeFaces findCubeFaces(const fs::path& folder) {
  const std::map<FaceName, FaceFiles> cubes = cubesIn(folder);
  std::vector<const std::pair<const FaceName, FaceFiles>*> complete;
  for (const auto& cube : cubes)
    if (countOf(cube.second) == kFaces) complete.push_back(&cube);
  if (complete.empty()) refuseIncomplete(folder, cubes);
  if (complete.size() > 1)
    throwInput("{}: has {} cube maps; a folder may have one", folder.string(), complete.size());
  CubeFaces faces{.files = {}, .namesAxes = complete[0]->first.names->areAxes};
  for (size_t face = 0; face < kFaces; ++face) {
    std::vector<fs::path> files = complete[0]->second[face];
    std::ranges::sort(files);
    if (files.size() > 1)
      throwInput("{}: {} and {} are the same face of a cube map", folder.string(),
                 printableName(files[0].filename().string()),
                 printableName(files[1].filename().string()));
    faces.files[face] = files[0];
  }
  return faces;
}

ImageFile readCubeFaces(const fs::path& folder, const CubeFaces& faces) {
  ImageFile cube{.image = {}, .channels = {"R", "G", "B"}, .metadata = {}};
  cube.metadata[kMappingAttribute] = "cube-strip";
  for (int face = 0; face < kFaces; ++face) {
    const fs::path& path = faces.files[size_t(face)];
    ImageFile file = readImageFile(path);
    cube.integers |= file.integers;
    cube.messages.insert(cube.messages.end(), file.messages.begin(), file.messages.end());
    const Image image = colorOf(std::move(file), path);
    const int n = image.width;
    if (n != image.height)
      throwInput("{}: is {} x {}; the face of a cube map must be square", path.string(), n,
                 image.height);
    if (cube.image.empty()) {
      checkImageSize(folder, int64_t(kFaces) * n, n, 3);
      checkImageMemory(folder, int64_t(kFaces) * n, n, 3);
      cube.image = Image(kFaces * n, n, 3);
    }
    if (n != cube.image.height)
      throwInput("{}: is {} x {}, but {} is {} x {}", path.string(), n, n,
                 faces.files[0].filename().string(), cube.image.height, cube.image.height);
    for (int y = 0; y < n; ++y)
      std::copy_n(image.at(0, y), 3 * size_t(n), cube.image.at(face * n, y));
  }
  if (faces.namesAxes) orientAxes(folder, cube);
  return cube;
}

bool isCubeFace(const fs::path& file) {
  bool isFace = false;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  findFaceName(file, [&](const FaceName& name, size_t) {
    isFace |= countOf(cubesIn(folder)[name]) >= kFaces - 1;
  });
  return isFace;
}

}  // namespace chromeball
