// SPDX-License-Identifier: Apache-2.0
#include "front/settings.h"
#include "lighting/strategy.h"
#include "scene/motion.h"

namespace chromeball {

std::vector<Setting> modelRows() {
  using enum SettingType;
  return {
      {.key = "file", .type = File, .absent = "required", .help = "A model: .gltf or .glb."},
      pointRow("translation", "0, 0, 0", "Translation of the model."),
      {.key = "rotation",
       .type = Compound,
       .form = "three angles, or a quaternion x, y, z, w",
       .unit = "degrees",
       .absent = "none",
       .help = "Turns the model about the fixed axes X, then Y, then Z; or as glTF's rotation."},
      {.key = "scale",
       .type = Compound,
       .form = "a number other than 0, or three",
       .absent = "1",
       .help =
           "Scales the model along X, Y and Z: a change of its unit, which absorption in glass, "
           "the range of lamps and the height of orthographic cameras follow (by the cube root "
           "of the volume's factor)."},
      {.key = "animation",
       .argument = "NAME",
       .type = Name,
       .absent = "the first if `time` is given, else the rest pose",
       .help = "Shows the models in the pose of this animation."},
      {.key = "time",
       .option = "animation-time",
       .argument = "SECONDS",
       .type = Number,
       .unit = "seconds",
       .absent = "0",
       .help = "The time of the animation."},
      {.key = "variant",
       .argument = "NAME",
       .type = Name,
       .absent = "the default materials",
       .help = "Shows the models in this variant of their materials (KHR_materials_variants)."},
  };
}

std::vector<Setting> cameraRows() {
  using enum SettingType;
  return {
      {.key = "name",
       .option = "camera",
       .argument = "NAME",
       .type = Name,
       .absent = "the model's first camera",
       .help = "One of the model's cameras, by its own name or that of its node."},
      {.key = "file",
       .option = "camera-file",
       .argument = "FILE.toml",
       .type = File,
       .absent = "none",
       .help = "A file with a [camera] of its own, principal point and distortion included, as "
               "`chromeball camera solve` writes it."},
      pointRow("position", "none", "Position of the camera."),
      pointRow("look_at", "none", "The point in the middle of the image."),
      {.key = "up",
       .type = Compound,
       .form = "three numbers",
       .absent = "0, 1, 0",
       .help = "The direction that is up in the image."},
      {.key = "fov",
       .argument = "DEGREES",
       .type = Number,
       .range = {.min = 0, .max = 180, .excludesMin = true, .excludesMax = true},
       .unit = "degrees",
       .absent = "39.6; of a model's camera its own; of one that frames the model 47, or 60 in a "
                 "room",
       .help = "Vertical field of view. A camera that frames the model stands accordingly nearer "
               "or farther."},
      {.key = "view",
       .argument = "AZIMUTH[,ELEVATION[,ROLL]]",
       .type = Numbers,
       .form = "one angle, two or three, or front, back, left, right, above or below",
       .counts = {1, 2, 3},
       .named = {{"front", {0, 0}},
                 {"back", {180, 0}},
                 {"left", {-90, 0}},
                 {"right", {90, 0}},
                 {"above", {0, 90}},
                 {"top", {0, 90}},
                 {"below", {0, -90}},
                 {"bottom", {0, -90}}},
       .range = {.min = -360, .max = 360},
       .unit = "degrees",
       .absent = "24, 18; or what suits the model's shape",
       .help = "The direction from which a camera frames the model: front (0,0: from +Z), back "
               "(180,0), left (-90,0), right (90,0: from +X), above or top (0,90), below or bottom "
               "(0,-90), or other angles; an azimuth alone from 18 degrees above. ROLL turns the "
               "camera counter-clockwise. A room is then seen from outside. The model's own "
               "cameras are not used."},
      {.key = "look_at_node",
       .option = "look-at",
       .argument = "NODE",
       .type = Name,
       .absent = "the whole model",
       .help = "A camera frames this node of the model and those below it. The model's own cameras "
               "are not used."},
      {.key = "zoom",
       .argument = "FACTOR",
       .type = Number,
       .range = kPositive,
       .absent = "1",
       .help = "Enlarges the middle of what the camera shows."},
      numberRow("orthographic", kPositive, "metres", "perspective",
                "Parallel projection: the height of the view."),
      numberRow("aperture", kPositive, "metres", "a pinhole", "Diameter of the lens (thin lens)."),
      numberRow("focus", kPositive, "metres", "none",
                "Distance of the plane in focus, along the camera's axis."),
      {.key = "shutter",
       .argument = "FRAMES",
       .type = Number,
       .range = {.min = 0, .max = 100},
       .unit = "of the time 1 / fps of a frame",
       .absent = "0: an image of one instant",
       .help = "Motion blur: how long the shutter is open, from the time of the frame or of "
               "--animation-time on; 0.5 is a shutter of 180 degrees. What moves meanwhile: nodes, "
               "skins and morphs of an animation, its cameras and lamps, and the orbit of the "
               "camera."},
      {.key = "shutter_steps",
       .type = Integer,
       .range = {.min = 1, .max = kMostMotionSteps},
       .absent = "8",
       .help = "While the shutter is open, vertices, lamps and camera move along so many straight "
               "lines, one after the other; a warning says if they are far from the true motion."},
      {.key = "principal_point",
       .type = Compound,
       .form = "two numbers",
       .range = {.min = -10, .max = 10},
       .unit = "fractions of the image's width and height",
       .absent = "0.5, 0.5: the middle",
       .help = "Where the lens's axis meets the image, from the top left: a lens that is shifted, "
               "or a photograph that was cropped."},
      {.key = "distortion",
       .type = Compound,
       .form = "a number, k1, or two, [k1, k2]",
       .absent = "none",
       .help = "The lens's radial distortion: what a pinhole would show at (x, y) focal lengths "
               "from the principal point appears at (1 + k1 r^2 + k2 r^4) (x, y), r^2 = x^2 + y^2. "
               "`fov` is that of the pinhole."},
  };
}

std::vector<Setting> probeRows() {
  using enum SettingType;
  return {
      {.key = "file",
       .option = "probe",
       .argument = "FILE",
       .type = Source,
       .absent = "the model's own light",
       .help = "Light probe: an HDR image of all directions (.hdr, .exr, .pfm, ...), or a folder "
               "with the six faces of a cube map (px.hdr, nx.hdr, ... or right, left, top, bottom, "
               "back, front, which is -Z)."},
      {.key = "mapping",
       .option = "probe-mapping",
       .type = Choice,
       .fallback = "auto",
       .choices = {"auto", "lat-long", "angular", "mirror-ball", "cube-cross", "cube-strip",
                   "cube-3x2"},
       .help = "How the probe's image maps to directions; auto detects it."},
      {.key = "rotation",
       .option = "probe-rotation",
       .argument = "YAW[,PITCH,ROLL]",
       .type = Numbers,
       .form = "one angle, three (yaw, pitch, roll), or a quaternion (x, y, z, w)",
       .counts = {1, 3, 4},
       .unit = "degrees",
       .fallback = "0",
       .help = "Turns the environment about the fixed axes Z (roll), then X (pitch), then Y (yaw), "
               "counter-clockwise seen from the tip of the axis: yaw from above."},
      {.key = "rotation_keys",
       .type = Compound,
       .form = "pairs [seconds, rotation], each later than the one before",
       .absent = "`rotation` at all times",
       .help = "The rotation at times of an animation, as a number or an array like `rotation`; "
               "between them linear in the yaw, or the shortest way if one is tilted; see --frames "
               "and --animation-time."},
      {.key = "scale",
       .option = "probe-scale",
       .argument = "R[,G,B]",
       .type = Numbers,
       .form = "a number, or three (r, g, b)",
       .counts = {1, 3},
       .range = kNotNegative,
       .fallback = "1",
       .help =
           "Factor on the probe's radiance. In the scene file also \"plate\": for each channel, "
           "what a composite's ground needs to look as in the plate (`ground_reflectance`)."},
  };
}

std::vector<Setting> lightingRows() {
  using enum SettingType;
  std::vector<std::string_view> strategies = strategyNames();
  strategies.insert(strategies.begin(), "auto");
  return {
      {.key = "strategy",
       .argument = "NAME[:COUNT]",
       .type = Name,
       .fallback = "auto",
       .choices = strategies,
       .help = "How the probe is sampled. A COUNT is for strategies that make lights or regions.",
       .renderOnly = true},
      {.key = "mis",
       .type = Choice,
       .fallback = "balance",
       .choices = {"off", "balance", "power"},
       .help = "Heuristic of multiple importance sampling."},
      {.key = "sun_angle",
       .argument = "DEGREES",
       .type = Number,
       .range = kSunAngle,
       .unit = "degrees",
       .absent = "as measured in the probe",
       .help = "Diameter of the discs of the strategy `suns`; their irradiance stays. The Sun's is "
               "0.5323."},
      {.key = "from",
       .option = "light-from",
       .argument = "PART",
       .type = Choice,
       .fallback = "all",
       .choices = {"all", "suns", "rest"},
       .help = "What lights the scene: all, only the suns of the probe and of [[light]], or all "
               "but these. The two parts add up to the whole, unless a [[source]] holds such a sun "
               "of the probe: its light is then no sun's."},
      {.key = "show_lights",
       .type = Flag,
       .help = "The camera and mirrors see, instead of the probe, the lights by which the strategy "
               "replaces it: discs of at least a degree.",
       .renderOnly = true},
      {.key = "lights",
       .argument = "FACTOR",
       .type = Factor,
       .range = kNotNegative,
       .fallback = "1",
       .help = "Factor on the models' own punctual lights, or off; surfaces that emit stay."},
      {.key = "light_units",
       .type = Choice,
       .fallback = "photometric",
       .choices = {"photometric", "radiometric"},
       .help = "Units of the models' punctual lights: candela and lux at 683 lm/W, as Blender "
               "writes them, or W/sr and W/m^2."},
  };
}

}  // namespace chromeball
