// SPDX-License-Identifier: Apache-2.0
// Directional lights as a C header for OpenGL's fixed-function lighting.
#pragma once

#include <string>

#include "lighting/light_file.h"

namespace chromeball {

// Arrays for glLightfv() and glLightModelfv(), and a function that passes them (Madsen et al. 2003,
// eq. 4 to 6). A surface with the coefficients kd = ka = 1 then has the radiance of a white
// Lambertian surface: L_j = E_j / pi of each light, L_A = the ambient radiance.
std::string formatOpenGl(const LightRig& rig);

}  // namespace chromeball
