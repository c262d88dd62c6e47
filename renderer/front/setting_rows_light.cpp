// SPDX-License-Identifier: Apache-2.0
#include "front/settings.h"

namespace chromeball {

std::vector<Setting> lightRows() {
  using enum SettingType;
  const auto colorRow = [](std::string_view key, std::string_view unit, std::string_view absent,
                           std::string_view help) -> Setting {
    return {.key = key,
            .type = Compound,
            .form = "a number (grey), or three",
            .range = kNotNegative,
            .unit = unit,
            .absent = absent,
            .help = help};
  };
  return {
      {.key = "type",
       .type = Choice,
       .fallback = "sun",
       .choices = {"sun", "point", "spot", "disc", "list"},
       .help = "The kind of lamp. A sun is a distant disc besides those in the probe; a list is a "
               "file of `chromeball lights` or `probe split`, and needs no type."},
      {.key = "file",
       .type = Compound,
       .form = "a file name",
       .absent = "required for a list",
       .help = "The .json of a list. Lights with an angle are suns, those without are directional "
               "lamps; ambient light comes from all directions."},
      {.key = "rotation",
       .type = Compound,
       .form = "one angle, three (yaw, pitch, roll), or a quaternion (x, y, z, w)",
       .unit = "degrees",
       .absent = "none",
       .help = "Turns the lights of a list as [probe] `rotation` turns the environment, which does "
               "not turn them: give both for a probe and its own suns."},
      {.key = "name",
       .type = Name,
       .absent = "sun, or light",
       .help = "Name of the lamp, for `local_scene` and light groups (there with _ for dots, "
               "commas, = and spaces); those of a list get numbers: NAME_0."},
      pointRow("position", "required for a point, spot or disc", "Position of the lamp."),
      {.key = "direction",
       .type = Compound,
       .form = "three numbers",
       .absent = "required for a spot, disc or sun",
       .help = "Direction in which a spot or disc emits, or from the scene to a sun; of any length "
               "except 0."},
      colorRow("intensity", "W/sr", "from `power`",
               "Radiant intensity of a point or spot light, on the axis of a spot."),
      colorRow("radiance", "W/(m^2 sr)", "from `power`", "Radiance of a disc or sun."),
      colorRow("irradiance", "W/m^2", "from `radiance`",
               "Irradiance of a sun on a surface that faces it, in place of `radiance`."),
      numberRow("angle", kSunAngle, "degrees", "0.5323, of the Sun", "Angular diameter of a sun."),
      {.key = "visible",
       .type = Flag,
       .fallback = "true",
       .help = "Whether the camera and mirrors see a sun, or a list's suns and ambient light."},
      colorRow("power", "watts", "none", "Radiant flux, in place of `intensity` or `radiance`."),
      numberRow("range", kPositive, "metres", "unlimited",
                "Distance at which a point or spot light fades to 0 (KHR_lights_punctual)."),
      {.key = "inner_angle",
       .type = Compound,
       .form = "a number from 0 to `outer_angle`",
       .unit = "degrees",
       .absent = "0",
       .help = "Angle from a spot's axis up to which it has its full intensity."},
      numberRow("outer_angle", {.min = 0.01, .max = 90}, "degrees", "45",
                "Angle from a spot's axis at which its light ends."),
      numberRow("radius", {.min = 0, .max = 1e12, .excludesMin = true}, "metres",
                "required for a disc", "Radius of a disc."),
  };
}

std::vector<Setting> sourceRows() {
  using enum SettingType;
  return {
      {.key = "probe_polygon",
       .type = Compound,
       .form = "three to 64 corners, [[u, v], ...]",
       .unit = "pixels of the probe's image",
       .absent = "required without `file`",
       .help = "The corners of the source, from the top left of the image; its edges are great "
               "circles."},
      {.key = "file",
       .type = Compound,
       .form = "a file name",
       .absent = "none",
       .help = "Polygons of a .json, as `chromeball lights --suggest` writes it, in place of "
               "`probe_polygon`."},
      {.key = "illum",
       .type = Flag,
       .fallback = "true",
       .help = "Only light samples find the source; the camera and mirrors see the probe. Else all "
               "rays see a polygon of constant radiance."},
      {.key = "name",
       .type = Name,
       .fallback = "source",
       .help = "Name of its light group; those of a file get numbers: NAME_0."},
      {.key = "offset",
       .type = Number,
       .range = kNotNegative,
       .unit = "metres",
       .fallback = "0",
       .help = "Distance from the wall, as RADIANCE needs it. Without effect: here walls do not "
               "hide the sources on them."},
  };
}

}  // namespace chromeball
