// SPDX-License-Identifier: Apache-2.0
// All settings that determine an image's pixels, in one table: for the EXR header, the statistics
// and the identity of a stored render.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <map>
#include <string>
#include <vector>

#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "scene/scene.h"
#include "session/load_scene.h"

namespace chromeball {

// describe() (description/describe.h) for a description that loadScene() has completed, and
// properties found in its files:
//   files                     all files read: models, their buffers and images, probe, plate
//   probe-found               the mapping that `probe-mapping` resolved to
//   cameraPosition (metres), cameraFov (vertical, degrees; 0: orthographic), lensRadius, focus
//   worldToCamera, worldToNDC as OpenEXR and RenderMan define them: for row vectors; camera space
//                             is left-handed and looks along +Z; NDC is (0, 0) at the top left
//                             corner and (1, 1) at the bottom right
// The number of samples is left out: if a limit determined it, the limit reproduces the image, but
// the number does not, since the passes differ.
nlohmann::ordered_json describeLoaded(const LoadedScene& loaded);

// The same as attributes of an EXR file, without loss: numbers as floats, or as doubles where a
// float does not hold them; matrices as such, other lists as JSON.
Metadata toMetadata(const nlohmann::ordered_json& description);

// The common properties of all renders of a comparison, as JSON: the description without the
// settings that the comparison varies, hashes of the contents of all files, and the number of
// threads, on which times depend.
std::string identityOf(const LoadedScene& loaded);

// The same for parts of one render (checkpoint.h): also with the settings that a comparison
// varies, and without threads.
std::string renderIdentity(const LoadedScene& loaded);
// The same for a scene and its light, whatever the camera, the image and the sampling, and the time
// of an animation in which no geometry moves.
std::string lightIdentity(const LoadedScene& loaded);
std::string withoutParts(const std::string& identity);  // without `shard` and `crop`

// The first difference between two identities: "`mis` was off and is power".
std::string differenceOf(const std::string& stored, const std::string& own);

// The names of the numbers in the layers `node` and `material`.

// An attribute `manifest/LAYER` for each of these layers in the image: JSON {"1": "name", ...} in
// ASCII, as in Cryptomatte's manifests (Friedman and Jones 2015) but with our numbers instead of
// hashes. It lists only numbers that occur in the image. Names are truncated to 256 bytes; beyond a
// total of 1 MiB, names are left out and their number is stored under "omitted".
Metadata idManifests(const OutputImage& output, const Scene& scene);

// The contents of such an attribute; empty if it is not well-formed.
std::map<int, std::string> readManifest(const Metadata& metadata, const std::string& layer);

}  // namespace chromeball
