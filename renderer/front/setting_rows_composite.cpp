// SPDX-License-Identifier: Apache-2.0
#include "front/settings.h"

namespace chromeball {

std::vector<Setting> compositeRows() {
  using enum SettingType;
  return {
      {.key = "plate",
       .type = File,
       .absent = "required but for a shadow catcher",
       .help = "The photograph. Floats are linear; integers are decoded from sRGB unless the file "
               "states another curve."},
      {.key = "local_scene",
       .type = Compound,
       .form = "a node's name, or several",
       .absent = "required without `ground`",
       .help = "Nodes that model real surfaces in the photograph, including their descendants; all "
               "other nodes of the model are synthetic objects."},
      {.key = "ground",
       .type = Flag,
       .help = "Adds the ground to the local scene: a level plane at `ground_height`, as far as "
               "the camera sees it and the objects matter; for `--shadow-catcher ground` it is at "
               "the model's lowest point."},
      {.key = "ground_height",
       .type = Number,
       .unit = "metres",
       .fallback = "0",
       .help = "The ground's y coordinate: 0 also where the model does not stand on it."},
      {.key = "ground_reflectance",
       .type = Compound,
       .form = "a number (grey), or three",
       .range = {.min = 0.001, .max = 1},
       .absent =
           "0.25; with `[probe] scale = \"plate\"` the plate's luminance around the objects if "
           "its file holds integers, within `ground_reflectance_range`",
       .help = "The ground's base colour where `reflectance` does not find it, and around the "
               "objects for `[probe] scale = \"plate\"`."},
      {.key = "ground_reflectance_range",
       .type = Compound,
       .form = "two numbers, [least, most]",
       .range = {.min = 0.001, .max = 1},
       .absent = "0.1, 0.5: asphalt to dry sand",
       .help = "Between what the ground's reflectance may be: the uncertainty of `[probe] scale = "
               "\"plate\"`."},
      {.key = "ground_in_plate",
       .type = Compound,
       .form = "four numbers, [left, top, right, bottom]",
       .range = {.min = 0},
       .unit = "pixels of the plate's file, from its top left",
       .absent = "where the plane is seen around the objects",
       .help = "A part of the plate that shows the ground and nothing else, for `[probe] scale = "
               "\"plate\"`."},
      {.key = "mode",
       .type = Choice,
       .fallback = "difference",
       .choices = {"difference", "ratio", "shadow-catcher"},
       .help = "alpha L_obj + (1 - alpha) (plate + L_obj - L_noobj), or plate x L_obj / L_noobj; "
               "or the objects and their shadows, without a plate, as a premultiplied image with "
               "alpha to be laid over one."},
      {.key = "reflectance",
       .type = Choice,
       .absent = "model; with `ground` flat, or plate if the local scene has more or other lights",
       .choices = {"model", "plate", "flat"},
       .help = "The local scene's base colour: the model's, found from the plate by rendering, or "
               "found from the plate by the exact irradiance of a flat local scene."},
      {.key = "iterations",
       .type = Integer,
       .range = {.min = 1, .max = 20},
       .fallback = "2",
       .help = "Iterations of `reflectance = \"plate\"`; one suffices if no part of the local "
               "scene sees another."},
      {.key = "specular",
       .type = Number,
       .range = {.min = 0, .max = 1},
       .absent = "the model's gloss; 1 if `roughness` is given",
       .help = "Strength of the local scene's gloss; 1 is an index of refraction of 1.5."},
      {.key = "roughness",
       .type = Number,
       .range = {.min = 0, .max = 1},
       .absent = "the model's gloss; 0.2 if `specular` is given",
       .help = "Roughness of the local scene's gloss, as in glTF."},
  };
}

std::vector<Setting> surroundingsRows() {
  using enum SettingType;
  return {
      {.key = "shape",
       .type = Choice,
       .absent = "required",
       .choices = {"box", "sphere", "model"},
       .help = "A box or a sphere that holds the whole model, or a model of the room."},
      pointRow("min", "required for a box", "The box's corner with the smallest coordinates."),
      pointRow("max", "required for a box", "The box's corner with the largest coordinates."),
      pointRow("center", "required for a sphere", "The sphere's centre."),
      numberRow("radius", kPositive, "metres", "required for a sphere", "The sphere's radius."),
      {.key = "file",
       .type = File,
       .absent = "required for a model",
       .help = "A glTF file of the room; only its geometry is used."},
      pointRow("capture", "the middle; required for a model",
               "The position at which the probe was captured, inside."),
  };
}

}  // namespace chromeball
