// SPDX-License-Identifier: Apache-2.0
#include "front/setting_rows.h"

namespace chromeball {

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
