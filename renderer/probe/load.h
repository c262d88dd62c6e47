// SPDX-License-Identifier: Apache-2.0
// Reads a probe's file: image, mapping, repair, and conversion to a lat-long map for rendering.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/message.h"
#include "image/image.h"
#include "image/io/read_image.h"
#include "probe/edit.h"
#include "probe/mapping.h"

namespace chromeball {

struct LoadedProbe {
  Image latLong;                       // three channels, finite, not negative
  Mapping mapping = Mapping::LatLong;  // of the file
  int fileWidth = 0, fileHeight = 0;   // or of the map from memory; 0: there is neither
  bool detected = false;               // the mapping; false: given by the user
  bool certain = true;                 // false: the detected mapping deserves a warning
  std::string reason;                  // for the detected mapping: "its shape is 2:1"
  bool turned = false;  // by 180 degrees: a lat-long map whose `envmap` attribute is set
  RepairReport repair;
  bool hasIntegerTexels = false;   // of 8 or 16 bits
  float maximum = 0;               // over texels and channels
  double fractionAtMaximum = 0;    // of the texels; 0 if all are equal
  bool hasSuns = false;            // only known if they, or the rest, are the light
  Messages messages;               // of its reader, each "FILE: ..."
  std::vector<std::string> files;  // paths of those read
};

// `mapping` is a name as on the command line. "auto" takes the mapping from the `envmap` or
// `mapping` attribute of an EXR, or the comment `mapping` of an HDR, else detects it
// (detectMapping()). A lat-long map with `envmap` has +Z in its centre and +X at its left quarter
// (OpenEXR's ImfEnvmap.h); it is turned by 180 degrees, to agree with the cube map of the same
// environment. A lat-long file of any shape keeps its texels; others are converted at latLongSize()
// (convert.h). `path` may be a folder with the six faces of a cube map (cube_faces.h); one face
// alone is refused unless a mapping is given. Throws InputError; it starts with `mappingLocation`
// if the mapping is at fault.
LoadedProbe loadProbe(const std::filesystem::path& path, std::string_view mapping = "auto",
                      std::string_view mappingLocation = "mapping");

// The same for an image from memory, of three channels; errors and messages call it `name`. Throws
// InputError, with its position, for a texel that is not finite, or negative.
LoadedProbe loadProbe(Image image, std::string_view mapping, std::string_view mappingLocation,
                      const std::string& name);

// Warnings for the user, each "FILE: ..."; often none.
std::vector<std::string> warnings(const LoadedProbe& probe, const std::filesystem::path& path);

// What was detected, and why: "FILE: detected as ...".
std::string detection(const LoadedProbe& probe, const std::filesystem::path& path);

// All messages about the file: the reader's, a note where the map may be another one, the warnings.
Messages probeMessages(const LoadedProbe& probe, const std::filesystem::path& path);

// The warnings about the light itself: the probe is black, or clipped.
std::vector<std::string> lightWarnings(const LoadedProbe& probe, const std::filesystem::path& path);

// Detects the mapping of an image from its shape and its texels.

struct DetectedMapping {
  Mapping mapping;
  std::string reason;  // completes a sentence: "because its shape is 2:1"
  bool certain;        // false: the user should be warned
};

// The shape decides; for squares and crosses, also whether the image is black where the mapping
// shows no direction. An angular map and an ideal mirror ball may both be black outside the same
// disc: their texels do not tell them apart, and the angular map is the usual one.
DetectedMapping detectMapping(const Image& image);

// The mapping that this program has written with an image of this size; nullopt if there is none.
// Other programs may have the same attribute.
std::optional<Mapping> namedMapping(const Metadata& metadata, const ImageSize& size);

}  // namespace chromeball
