// SPDX-License-Identifier: Apache-2.0
#include "image/io/cube_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr int kFaces = 6;

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
        "nz; posx, negx, ...; or right, left, top, bottom, back, front",
        folder.string());
  std::vector<std::string> missing;
  for (size_t face = 0; face < kFaces; ++face)
    if (fullest->second[face].empty())
      missing.push_back(fullest->first.prefix + std::string(fullest->first.names->names[face]));
  throwInput("{}: its cube map has no file {}", folder.string(),
             printable(fmt::format("{}", fmt::join(missing, ", "))));
}

}  // namespace

std::vector<fs::path> cubeFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;  // of a file, or a folder that may not be read: it has none
  for (const auto& entry : fs::directory_iterator(folder, error))
    findFaceName(entry.path(), [&](const FaceName&, size_t) { files.push_back(entry.path()); });
  return files;
}

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

bool isCubeFace(const fs::path& file) {
  bool isFace = false;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  findFaceName(file, [&](const FaceName& name, size_t) {
    isFace |= countOf(cubesIn(folder)[name]) >= kFaces - 1;
  });
  return isFace;
}

}  // namespace chromeball
