// SPDX-License-Identifier: Apache-2.0
// Windows and lamps of a probe as polygons: lights --suggest N, lights --polygons P.json.
#pragma once

#include <optional>
#include <string>

#include "light_options.h"
#include "lighting/export/light_file.h"

namespace chromeball {

struct PolygonRequest {
  LightsProbe probe;
  std::string output, preview;  // preview: perhaps empty
  std::optional<int> suggest;   // number of polygons; none: the file's
  std::string polygons;
  LightFormat format = LightFormat::Json;  // of their lights
  LightUnits units = LightUnits::Photometric;
  Rotation rotation;  // of the lights
};

// Writes the suggested polygons, which [[source]] reads; or a directional light for each polygon of
// the file, in the direction of its vector irradiance. Prints them. Throws InputError.
void runPolygons(const PolygonRequest& request);

}  // namespace chromeball
