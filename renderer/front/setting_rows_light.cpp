// SPDX-License-Identifier: Apache-2.0
#include "front/settings.h"

namespace chromeball {

std::vector<Setting> lightRows() {
  using enum SettingType;
  std::vector<Setting> rows;
  const auto add = [&](Setting row) {
    row.section = "light";
    rows.push_back(std::move(row));
  };
  const std::string_view color = "a number (grey), or three";
  add({.key = "type",
       .type = Choice,
       .fallback = "sun",
       .choices =
           [] {
             return std::vector<std::string_view>{"sun", "point", "spot", "disc", "list"};
           },
       .help = "The kind of lamp. A sun is a distant disc besides those in the probe; a list is a "
               "file of `chromeball lights` or `probe split`, and needs no type."});
  add({.key = "file",
       .type = Compound,
       .form = "a file name",
       .absent = "required for a list",
       .help = "The .json of a list. Lights with an angle are suns, those without are directional "
               "lamps; ambient light comes from all directions."});
  add({.key = "rotation",
       .type = Compound,
       .form = "one angle, three (yaw, pitch, roll), or a quaternion (x, y, z, w)",
       .unit = "degrees",
       .absent = "none",
       .help = "Turns the lights of a list as [probe] `rotation` turns the environment, which does "
               "not turn them: give both for a probe and its own suns."});
  add({.key = "name",
       .type = Name,
       .absent = "sun, or light",
       .help =
           "Name of the lamp, for `local_scene` and light groups (there with _ for dots, commas, = "
           "and spaces); those of a list get numbers: NAME_0."});
  add({.key = "position",
       .type = Compound,
       .form = "three numbers",
       .unit = "metres",
       .absent = "required for a point, spot or disc",
       .help = "Position of the lamp."});
  add({.key = "direction",
       .type = Compound,
       .form = "three numbers",
       .absent = "required for a spot, disc or sun",
       .help = "Direction in which a spot or disc emits, or from the scene to a sun; of any length "
               "except 0."});
  add({.key = "intensity",
       .type = Compound,
       .form = color,
       .range = kNotNegative,
       .unit = "W/sr",
       .absent = "from `power`",
       .help = "Radiant intensity of a point or spot light, on the axis of a spot."});
  add({.key = "radiance",
       .type = Compound,
       .form = color,
       .range = kNotNegative,
       .unit = "W/(m^2 sr)",
       .absent = "from `power`",
       .help = "Radiance of a disc or sun."});
  add({.key = "irradiance",
       .type = Compound,
       .form = color,
       .range = kNotNegative,
       .unit = "W/m^2",
       .absent = "from `radiance`",
       .help = "Irradiance of a sun on a surface that faces it, in place of `radiance`."});
  add({.key = "angle",
       .type = Compound,
       .form = "a number",
       .range = kSunAngle,
       .unit = "degrees",
       .absent = "0.5323, of the Sun",
       .help = "Angular diameter of a sun."});
  add({.key = "visible",
       .type = Flag,
       .fallback = "true",
       .help = "Whether the camera and mirrors see a sun, or a list's suns and ambient light."});
  add({.key = "power",
       .type = Compound,
       .form = color,
       .range = kNotNegative,
       .unit = "watts",
       .absent = "none",
       .help = "Radiant flux, in place of `intensity` or `radiance`."});
  add({.key = "range",
       .type = Compound,
       .form = "a number",
       .range = kPositive,
       .unit = "metres",
       .absent = "unlimited",
       .help = "Distance at which a point or spot light fades to 0 (KHR_lights_punctual)."});
  add({.key = "inner_angle",
       .type = Compound,
       .form = "a number from 0 to `outer_angle`",
       .unit = "degrees",
       .absent = "0",
       .help = "Angle from a spot's axis up to which it has its full intensity."});
  add({.key = "outer_angle",
       .type = Compound,
       .form = "a number",
       .range = {.min = 0.01, .max = 90},
       .unit = "degrees",
       .absent = "45",
       .help = "Angle from a spot's axis at which its light ends."});
  add({.key = "radius",
       .type = Compound,
       .form = "a number",
       .range = {.min = 0, .max = 1e12, .excludesMin = true},
       .unit = "metres",
       .absent = "required for a disc",
       .help = "Radius of a disc."});
  return rows;
}

std::vector<Setting> sourceRows() {
  using enum SettingType;
  std::vector<Setting> rows;
  const auto add = [&](Setting row) {
    row.section = "source";
    rows.push_back(std::move(row));
  };
  add({.key = "probe_polygon",
       .type = Compound,
       .form = "three to 64 corners, [[u, v], ...]",
       .unit = "pixels of the probe's image",
       .absent = "required without `file`",
       .help = "The corners of the source, from the top left of the image; its edges are great "
               "circles."});
  add({.key = "file",
       .type = Compound,
       .form = "a file name",
       .absent = "none",
       .help = "Polygons of a .json, as `chromeball lights --suggest` writes it, in place of "
               "`probe_polygon`."});
  add({.key = "illum",
       .type = Flag,
       .fallback = "true",
       .help = "Only light samples find the source; the camera and mirrors see the probe. Else all "
               "rays see a polygon of constant radiance."});
  add({.key = "name",
       .type = Name,
       .fallback = "source",
       .help = "Name of its light group; those of a file get numbers: NAME_0."});
  add({.key = "offset",
       .type = Number,
       .range = kNotNegative,
       .unit = "metres",
       .fallback = "0",
       .help =
           "Distance from the wall, as RADIANCE needs it. Without effect: here walls do not hide "
           "the sources on them."});
  return rows;
}

}  // namespace chromeball
