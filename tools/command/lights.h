// SPDX-License-Identifier: Apache-2.0
// chromeball lights: the arguments; and windows and lamps of a probe as polygons.
#pragma once

#include <optional>
#include <string>

#include "lighting/export/light_file.h"
#include "lighting/methods.h"
#include "math/rotation.h"
#include "probe_options.h"

namespace chromeball {

struct LightsArguments {
  LightsProbe probe;
  std::string method, output, format, preview, sphere, maxError, polygons, units;
  std::optional<std::string> seed;
  std::optional<int> suggest;  // so many polygons, in place of the file `polygons`
  std::optional<int> normals;  // of the sphere
  std::optional<double> angle;
  Rotation rotation;
  bool regions = false;
  LightRequest request;
};

// Writes the suggested polygons, which [[source]] reads; or a directional light for each polygon of
// the file, in the direction of its vector irradiance. Prints them. Throws InputError.
void runPolygons(const LightsArguments& a, LightFormat format, LightUnits units);

}  // namespace chromeball
