// SPDX-License-Identifier: Apache-2.0
#include "lighting/opengl_lights.h"

#include <fmt/format.h>

namespace chromeball {
namespace {

// A file's name may hold what would end a comment.
std::string inComment(std::string text) {
  for (char& c : text)
    if (c == '*' || c == '\\' || (c >= 0 && c < ' ')) c = '?';
  return text;
}

std::string row(const vec3& v, int last) {
  return fmt::format("{{{}, {}, {}, {}}}", v.x, v.y, v.z, last);
}

std::string array(const char* name, const Constellation& lights, int last,
                  vec3 (*of)(const DirectionalLight&)) {
  std::string text = fmt::format("static const float {}[][4] = {{\n", name);
  for (const DirectionalLight& light : lights) text += fmt::format("  {},\n", row(of(light), last));
  return text + "};\n";
}

constexpr const char* kHead =
    R"(/* {} directional lights{} in place of the probe
   {}
   by {}, for OpenGL's fixed-function lighting (Madsen et al. 2003, eq. 4).

   Radiances of a white surface, linear Rec. 709, not clipped: scale them by your exposure. The
   material's ambient and diffuse colours should be the same. Directions point to the lights, right-
   handed with +Y up: call setProbeLights() while the modelview matrix is the view. GL_MAX_LIGHTS is
   8 or more. */
)";

constexpr const char* kLoop = R"(  static const float black[4] = {0, 0, 0, 1};
  int j;
  for (j = 0; j < kProbeLights; ++j) {
    glEnable(GL_LIGHT0 + j);
    glLightfv(GL_LIGHT0 + j, GL_POSITION, kProbeDirection[j]);
    glLightfv(GL_LIGHT0 + j, GL_DIFFUSE, kProbeDiffuse[j]);
    glLightfv(GL_LIGHT0 + j, GL_AMBIENT, black);
    glLightfv(GL_LIGHT0 + j, GL_SPECULAR, black);
  }
)";

}  // namespace

// C has no empty arrays, so without lights only the ambient light is written.
std::string formatOpenGl(const LightRig& rig) {
  std::string text =
      fmt::format(kHead, rig.lights.size(), rig.ambient ? " and the ambient light" : "",
                  inComment(rig.probe), inComment(rig.method));
  text += fmt::format("enum {{ kProbeLights = {} }};\n", rig.lights.size());
  text += fmt::format("static const float kProbeAmbient[4] = {};\n",
                      row(rig.ambient.value_or(Rgb(0)), 1));
  if (!rig.lights.empty()) {
    text += array("kProbeDirection", rig.lights, 0,
                  [](const DirectionalLight& light) { return light.direction; });
    text += array("kProbeDiffuse", rig.lights, 1,
                  [](const DirectionalLight& light) { return light.irradiance * kInvPi; });
  }
  text += "\nstatic void setProbeLights(void) {\n";
  if (!rig.lights.empty()) text += kLoop;
  return text + "  glLightModelfv(GL_LIGHT_MODEL_AMBIENT, kProbeAmbient);\n}\n";
}

}  // namespace chromeball
