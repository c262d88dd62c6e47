// SPDX-License-Identifier: Apache-2.0
// Which name each number of the layers `node` and `material` stands for.
#pragma once

#include <map>
#include <string>

#include "image/io/write_image.h"
#include "scene/scene.h"

namespace chromeball {

// For each of these layers that the picture has an attribute `manifest/LAYER`: JSON {"1": "name",
// ...} in ASCII, as Cryptomatte's manifests (Friedman and Jones 2015) with our numbers for its
// hashes. Only numbers that are in the picture are listed; names are cut at 256 bytes, and from a
// mebibyte on the rest is counted under "omitted".
Metadata idManifests(const OutputImage& output, const Scene& scene);

// What such an attribute says; empty where it is not well-formed.
std::map<int, std::string> readManifest(const Metadata& metadata, const std::string& layer);

}  // namespace chromeball
