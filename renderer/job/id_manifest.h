// SPDX-License-Identifier: Apache-2.0
// The names that the numbers in the layers `node` and `material` stand for.
#pragma once

#include <map>
#include <string>

#include "image/io/write_image.h"
#include "scene/scene.h"

namespace chromeball {

// For each of these layers of the image an attribute `manifest/LAYER`: JSON {"1": "name",
// ...} in ASCII, as Cryptomatte's manifests (Friedman and Jones 2015) with our numbers for its
// hashes. It lists only numbers in the image; names are cut at 256 bytes, and beyond a mebibyte in
// total the rest is counted under "omitted".
Metadata idManifests(const OutputImage& output, const Scene& scene);

// The contents of such an attribute; empty if it is not well-formed.
std::map<int, std::string> readManifest(const Metadata& metadata, const std::string& layer);

}  // namespace chromeball
