// SPDX-License-Identifier: Apache-2.0
// An image of a probe with the directional lights that replace it, for `lights --preview`.
#pragma once

#include <optional>
#include <vector>

#include "image/image.h"
#include "lighting/constellation/directional_light.h"

namespace chromeball {

// The lat-long map, tone mapped to display-linear colours, 1024 x 512, with a white dot at each
// light.
Image lightPreview(const Image& latLong, const Constellation& lights);

// The same with red dots, and with white outlines of the regions, one pixel wide with a black edge
// (Madsen and Laursen 2007, Fig. 1; HDRI book, Figs. 9.32 and 9.35). The partition, if any, is of
// `latLong`.
Image lightPreview(const Image& latLong, const Constellation& lights, const LightRegions& regions);

// A picture of the irradiance of a probe and of the lights that replace it, for `lights --sphere`.

// Irradiance, W/m^2, on the faces of an icosphere, in the order of icosphereNormals().
struct IrradianceSpheres {
  int subdivisions = 5;
  std::vector<glm::dvec3> probe, lights;
  std::optional<Rgb> ambient;  // radiance from all directions, part of `lights`
};

// The factor of the difference in the picture: the power of two, from 1 to 1024, that makes it as
// large as can be shown.
double differenceGain(const IrradianceSpheres& spheres);

// White Lambertian spheres in display-linear colours (Madsen et al. 2003, Figs. 2, 3 and 5 to 7;
// Madsen and Laursen 2007, Fig. 2): from left to right lit by the probe (radiance E / pi), lit by
// the lights, and their difference. Above from the front, looking along -Z; below from the back.
// Faces are flat. All have one exposure, which makes the brightest channel of any face white; the
// difference is multiplied by differenceGain() too. In it, middle grey (sRGB 0.5) is 0; a positive
// difference d, lights - probe, adds half of d's sRGB code value to the code value, a negative one
// subtracts it. A square on the right has the colour of the ambient light, if there is any.
Image irradianceSpheres(const IrradianceSpheres& spheres);

}  // namespace chromeball
