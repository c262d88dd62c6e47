// SPDX-License-Identifier: Apache-2.0
#include "job/setting_rows.h"
#include "lighting/strategy.h"

namespace chromeball {
namespace {

using Names = std::vector<std::string_view>;
using enum SettingType;

Names mappings() {
  return {"auto", "lat-long", "angular", "mirror-ball", "cube-cross", "cube-strip", "cube-3x2"};
}

Names strategies() {
  Names names = strategyNames();
  names.insert(names.begin(), "auto");
  return names;
}

void addModel(std::vector<Setting>& rows) {
  const auto add = [&](Setting row) {
    row.section = "model";
    rows.push_back(std::move(row));
  };
  add({.key = "file", .type = File, .absent = "required", .help = "A model: .gltf or .glb."});
  add({.key = "translation",
       .type = Compound,
       .form = "three numbers",
       .unit = "metres",
       .absent = "0, 0, 0",
       .help = "Translation of the model."});
  add({.key = "rotation",
       .type = Compound,
       .form = "three angles, or a quaternion x, y, z, w",
       .unit = "degrees",
       .absent = "none",
       .help = "Turns the model about the fixed axes X, then Y, then Z; or as glTF's rotation."});
  add({.key = "scale",
       .type = Compound,
       .form = "a number other than 0, or three",
       .absent = "1",
       .help = "Scales the model along X, Y and Z."});
  add({.key = "animation",
       .option = "animation",
       .argument = "NAME",
       .type = Name,
       .absent = "the first if `time` is given, else the rest pose",
       .help = "Shows the models in the pose of this animation."});
  add({.key = "time",
       .option = "animation-time",
       .argument = "SECONDS",
       .type = Number,
       .unit = "seconds",
       .absent = "0",
       .help = "The time of the animation."});
  add({.key = "variant",
       .option = "variant",
       .argument = "NAME",
       .type = Name,
       .absent = "the default materials",
       .help = "Shows the models in this variant of their materials (KHR_materials_variants)."});
}

void addCamera(std::vector<Setting>& rows) {
  const auto add = [&](Setting row) {
    row.section = "camera";
    rows.push_back(std::move(row));
  };
  add({.key = "name",
       .option = "camera",
       .argument = "NAME",
       .type = Name,
       .absent = "the model's first camera",
       .help = "One of the model's cameras, by its own name or that of its node."});
  add({.key = "position",
       .type = Compound,
       .form = "three numbers",
       .unit = "metres",
       .absent = "none",
       .help = "Position of the camera."});
  add({.key = "look_at",
       .type = Compound,
       .form = "three numbers",
       .unit = "metres",
       .absent = "none",
       .help = "The point in the middle of the image."});
  add({.key = "up",
       .type = Compound,
       .form = "three numbers",
       .absent = "0, 1, 0",
       .help = "The direction that is up in the image."});
  add({.key = "fov",
       .type = Compound,
       .form = "a number",
       .range = {.min = 0, .max = 180, .excludesMin = true, .excludesMax = true},
       .unit = "degrees",
       .absent = "39.6",
       .help = "Vertical field of view."});
  add({.key = "orthographic",
       .type = Compound,
       .form = "a number",
       .range = kPositive,
       .unit = "metres",
       .absent = "perspective",
       .help = "Parallel projection: the height of the view."});
  add({.key = "aperture",
       .type = Compound,
       .form = "a number",
       .range = kPositive,
       .unit = "metres",
       .absent = "a pinhole",
       .help = "Diameter of the lens (thin lens)."});
  add({.key = "focus",
       .type = Compound,
       .form = "a number",
       .range = kPositive,
       .unit = "metres",
       .absent = "none",
       .help = "Distance of the plane in focus, along the camera's axis."});
}

void addProbe(std::vector<Setting>& rows) {
  const auto add = [&](Setting row) {
    row.section = "probe";
    rows.push_back(std::move(row));
  };
  add({.key = "file",
       .option = "probe",
       .argument = "FILE",
       .type = File,
       .absent = "the model's own light",
       .help = "Light probe: an HDR image of all directions (.hdr, .exr, .pfm, ...)."});
  add({.key = "mapping",
       .option = "probe-mapping",
       .argument = "NAME",
       .type = Choice,
       .fallback = "auto",
       .choices = mappings,
       .help = "How the probe's image maps to directions; auto detects it."});
  add({.key = "rotation",
       .option = "probe-rotation",
       .argument = "DEGREES",
       .type = Number,
       .unit = "degrees",
       .fallback = "0",
       .help = "Turns the environment about +Y, counter-clockwise seen from above."});
  add({.key = "rotation_keys",
       .type = Compound,
       .form = "pairs [seconds, degrees], each later than the one before",
       .absent = "`rotation` at all times",
       .help = "The rotation at times of an animation, linear between; see --frames and "
               "--animation-time."});
  add({.key = "scale",
       .option = "probe-scale",
       .argument = "FACTOR",
       .type = Number,
       .range = kNotNegative,
       .fallback = "1",
       .help = "Factor on the probe's radiance."});
}

void addLighting(std::vector<Setting>& rows) {
  const auto add = [&](Setting row) {
    row.section = "lighting";
    rows.push_back(std::move(row));
  };
  add({.key = "strategy",
       .option = "strategy",
       .argument = "NAME[:COUNT]",
       .type = Name,
       .fallback = "auto",
       .choices = strategies,
       .help = "How the probe is sampled. A COUNT is for strategies that make lights or regions.",
       .renderOnly = true});
  add({.key = "mis",
       .option = "mis",
       .argument = "NAME",
       .type = Choice,
       .fallback = "balance",
       .choices =
           [] {
             return Names{"off", "balance", "power"};
           },
       .help = "Heuristic of multiple importance sampling."});
  add({.key = "sun_angle",
       .option = "sun-angle",
       .argument = "DEGREES",
       .type = Number,
       .range = kSunAngle,
       .unit = "degrees",
       .absent = "as measured in the probe",
       .help = "Diameter of the discs of the strategy `suns`; their irradiance stays. The Sun's is "
               "0.5323."});
  add({.key = "from",
       .option = "light-from",
       .argument = "PART",
       .type = Choice,
       .fallback = "all",
       .choices =
           [] {
             return Names{"all", "suns", "rest"};
           },
       .help = "What lights the scene: all, only the suns of the probe and of [[light]], or all "
               "but these. The two parts add up to the whole."});
  add({.key = "show_lights",
       .option = "show-lights",
       .type = Flag,
       .help = "The camera and mirrors see, instead of the probe, the lights by which the strategy "
               "replaces it: discs of at least a degree.",
       .renderOnly = true});
  add({.key = "lights",
       .option = "lights",
       .argument = "FACTOR",
       .type = Factor,
       .range = kNotNegative,
       .fallback = "1",
       .help = "Factor on the models' own punctual lights, or off; surfaces that emit stay."});
  add({.key = "light_units",
       .option = "light-units",
       .argument = "NAME",
       .type = Choice,
       .fallback = "photometric",
       .choices =
           [] {
             return Names{"photometric", "radiometric"};
           },
       .help = "Units of the models' punctual lights: candela and lux at 683 lm/W, as Blender "
               "writes them, or W/sr and W/m^2."});
}

}  // namespace

std::vector<Setting> sceneRows() {
  std::vector<Setting> rows;
  addModel(rows);
  addCamera(rows);
  addProbe(rows);
  addLighting(rows);
  return rows;
}

}  // namespace chromeball
