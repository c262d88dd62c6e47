// SPDX-License-Identifier: Apache-2.0
// The omnidirectional mappings: direction to image position and back, and solid angles of texels in
// steradians.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "image/image.h"
#include "probe/fisheye.h"

namespace chromeball {

using glm::dvec2;
using glm::dvec3;

// The centre of the image (of the front face, for cube maps) shows -Z, its top +Y. Lat-long maps
// from other programs may show another direction there and need a rotation; those marked by OpenEXR
// are turned when loaded (load.h).
class Mapping {
 public:
  enum Kind {
    LatLong,          // u = (1 + atan2(Dx, -Dz)/pi)/2, v = acos(Dy)/pi
    AngularMap,       // the disc's radius is proportional to the angle from -Z
    MirrorBall,       // ideal, orthographic: the disc's radius is sin of half that angle
    VerticalCross,    // 3 x 4 faces: +Y / -X -Z +X / -Y / +Z upside down
    HorizontalCross,  // 4 x 3 faces: +Y / -X -Z +X +Z / -Y
    HorizontalStrip,  // 6 x 1 faces: +X -X +Y -Y +Z -Z, each as OpenEXR stores it: from inside
    VerticalStrip,    // 1 x 6 faces, the same
    CubeGrid,         // 3 x 2 faces, the same: +X -X +Y / -Y +Z -Z
    FisheyeDisc,      // a disc that may show a part of the sphere only
  };

  constexpr Mapping(Kind kind) : kind_(kind) {}
  constexpr Mapping(const Fisheye& lens) : kind_(FisheyeDisc), lens_(lens) {}

  constexpr Kind kind() const { return kind_; }

  // The lens of a disc. The angular map corresponds to an equidistant lens and the mirror ball to
  // an equisolid one, each with a field of view of 360 degrees. nullopt for maps that are no disc.
  std::optional<Fisheye> disc() const;

  bool operator==(const Mapping&) const = default;

 private:
  Kind kind_;
  Fisheye lens_;  // of a FisheyeDisc
};

struct ImageSize {
  int width, height;
};

// The position in the image (u right, v down, both in [0, 1]) that shows `direction` (of any
// length); outside the disc for a direction that a fisheye disc does not show.
dvec2 directionToUv(Mapping mapping, const dvec3& direction);

// The unit direction shown at `uv`; nullopt outside the disc or the faces.
std::optional<dvec3> uvToDirection(Mapping mapping, const dvec2& uv);

// Whether `uv` is inside the disc or the faces.
bool showsDirection(Mapping mapping, const dvec2& uv);

// The unit direction at `azimuth` degrees from -Z, counter-clockwise seen from above, and
// `elevation` degrees above the horizon.
dvec3 directionAt(double azimuth, double elevation);

// The unit direction at the centre of texel (x, y) of a lat-long map.
dvec3 texelDirection(const ImageSize& latLong, int x, int y);

// Numbers of cube faces side by side and one above another; {1, 1} for other mappings.
struct Layout {
  int columns, rows;
};
Layout faceLayout(Mapping mapping);

// "lat-long", "angular", "mirror-ball", "cube-cross", "fisheye:180:equidistant", ...
std::string mappingName(Mapping mapping);

// The mapping with this name for an image of this size: lat-long, angular, mirror-ball, cube-cross,
// cube-strip (the shape decides which cross or strip), cube-3x2 or fisheye[:FOV[:PROJECTION]]
// (fisheye.h). nullopt for auto. Throws InputError, which starts with `location`, if the name is
// unknown or does not fit the size.
std::optional<Mapping> parseMapping(std::string_view name, int width, int height,
                                    std::string_view location);

// The same where no size decides: crosses and strips are vertical, and auto is unknown.
Mapping parseMapping(std::string_view name, std::string_view location);

// The exact solid angle of a texel in `row` of a lat-long map: (2 pi / W)(cos(top) - cos(bottom)).
// All texels sum to 4 pi.
double texelSolidAngle(int row, int width, int height);

// Calls visit(x, y, radiance, solid angle) for each texel of a lat-long map, row by row.
template <class Visit>
void forTexels(const Image& latLong, const Visit& visit) {
  for (int y = 0; y < latLong.height; ++y) {
    const double solidAngle = texelSolidAngle(y, latLong.width, latLong.height);
    for (int x = 0; x < latLong.width; ++x) visit(x, y, latLong.rgb(x, y), solidAngle);
  }
}

// d(solid angle) / d(u v) at a valid position of a mapping.
double solidAngleJacobian(Mapping mapping, const dvec2& uv);

// The solid angles of the texels of an image whose centres show a direction.
struct TexelSolidAngles {
  double min, max;
  size_t texels;
};

// Exact but for discs other than of equal area (the mirror ball), where the texel's centre stands
// for all of it; texels on the rim of a disc count as if they were inside.
TexelSolidAngles texelSolidAngles(Mapping mapping, const ImageSize& image);

// The mean over the sphere of a lat-long map, constant over each texel: sum of radiance x solid
// angle / (4 pi).
dvec3 meanRadiance(const Image& latLong);

}  // namespace chromeball
