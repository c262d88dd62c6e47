// SPDX-License-Identifier: Apache-2.0
// The names of the numbers in the layers `node` and `material`.
#pragma once

#include <map>
#include <string>

#include "image/io/write_image.h"
#include "scene/scene.h"

namespace chromeball {

// An attribute `manifest/LAYER` for each of these layers in the image: JSON {"1": "name", ...} in
// ASCII, as in Cryptomatte's manifests (Friedman and Jones 2015) but with our numbers instead of
// hashes. It lists only numbers that occur in the image. Names are truncated to 256 bytes; beyond a
// total of 1 MiB, names are left out and their number is stored under "omitted".
Metadata idManifests(const OutputImage& output, const Scene& scene);

// The contents of such an attribute; empty if it is not well-formed.
std::map<int, std::string> readManifest(const Metadata& metadata, const std::string& layer);

}  // namespace chromeball
