// SPDX-License-Identifier: Apache-2.0
#include "lights.h"

#include <algorithm>
#include <cstdio>

#include "base/error.h"
#include "front/polygon_file.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "lighting/export/light_preview.h"
#include "messages.h"
#include "probe/polygon_source.h"

namespace chromeball {
namespace {

Constellation lightsOf(const std::vector<PolygonSource>& sources) {
  Constellation lights;
  for (const PolygonSource& source : sources)
    lights.push_back({vec3(source.direction()), Rgb(source.irradiance()), 0});
  return lights;
}

// The texels whose centres are inside each polygon; the later of two that overlap.
Partition partitionOf(const Image& latLong, const std::vector<PolygonSource>& sources) {
  Partition partition{
      int(sources.size()),
      std::vector<uint16_t>(size_t(latLong.width) * size_t(latLong.height), kNoRegion)};
  for (int y = 0; y < latLong.height; ++y)
    for (int x = 0; x < latLong.width; ++x) {
      const dvec3 direction = texelDirection({latLong.width, latLong.height}, x, y);
      for (size_t i = 0; i < sources.size(); ++i)
        if (sources[i].polygon.contains(direction))
          partition.label[size_t(y) * size_t(latLong.width) + size_t(x)] = uint16_t(i);
    }
  return partition;
}

std::vector<SphericalPolygon> polygonsOf(const LightsArguments& request, const LoadedProbe& probe) {
  if (request.suggest) return suggestPolygons(probe.latLong, *request.suggest);
  std::vector<SphericalPolygon> polygons;
  for (const PolygonCorners& corners : readPolygons(request.polygons))
    polygons.push_back(polygonOf(
        corners, probe, fmt::format("{}: polygons[{}]", request.polygons, polygons.size())));
  return polygons;
}

}  // namespace

void runPolygons(const LightsArguments& request, LightFormat format, LightUnits units) {
  constexpr int kMaxSuggested = 1000;
  if (request.suggest && !(request.rotation == Rotation()))
    throwInput("--probe-rotation: polygons are places in the probe's image; it turns lights");
  if (request.suggest && !(*request.suggest >= 1 && *request.suggest <= kMaxSuggested))
    throwInput("--suggest: should be a number of polygons from 1 to {}", kMaxSuggested);
  if (request.suggest && !request.polygons.empty())
    throwInput("--suggest: excludes --polygons; give one");
  if (request.suggest) checkOutputFile(request.output, {".json"});
  checkDistinct({request.output, request.preview}, {request.probe.file, request.polygons});
  const LoadedProbe probe = request.probe.loadWithFile();
  const PolygonExtraction extraction = extractPolygons(probe.latLong, polygonsOf(request, probe));
  const std::vector<PolygonSource>& sources = extraction.sources;
  for (size_t i = 0; i < sources.size(); ++i)
    if (sources[i].coveredTexels == 0)
      throwInput("{}: polygons[{}] is smaller than the probe's texels", request.polygons, i);
  const Constellation lights = lightsOf(sources);
  if (request.suggest) {
    std::vector<PolygonCorners> corners;
    for (const PolygonSource& source : sources) corners.push_back(cornersOf(source.polygon, probe));
    writePolygons(request.output, request.probe.file, corners, sources);
  } else {
    writeLights(request.output,
                {.probe = request.probe.file,
                 .method = "polygons",
                 .ambient = {},
                 .lights = turned(lights, request.rotation),
                 .units = units},
                format);
  }
  if (!request.preview.empty())
    print(writeImage(request.preview, lightPreview(probe.latLong, lights,
                                                   {partitionOf(probe.latLong, sources), {}})));
  say("polygons    {}\n", sources.size());
  for (size_t i = 0; i < sources.size(); ++i) {
    const Rgb& e = lights[i].irradiance;
    say("polygon     {} corners, {:.4g} sr, radiance {:.4g} {:.4g} {:.4g}, irradiance {:.4g} "
        "{:.4g} {:.4g}, unevenness {:.2g}%\n",
        sources[i].polygon.corners().size(), sources[i].polygon.solidAngle(), sources[i].radiance.x,
        sources[i].radiance.y, sources[i].radiance.z, e.x, e.y, e.z,
        100 * unevenness({&sources[i], 1}));
  }
}

}  // namespace chromeball
