// What is in a file, as a number.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace chromeball {

// A hash of a file's bytes. Throws InputError where it cannot be read.
uint64_t fingerprint(const std::string& path);

// The files beside a .gltf or .glb that it names: buffers and images, as far as they exist. None
// for any other kind of file.
std::vector<std::string> filesNamedBy(const std::string& model);

}  // namespace chromeball
