// SPDX-License-Identifier: Apache-2.0
#include "relit_attributes.h"

namespace chromeball {

void eraseNoise(Metadata& metadata) {
  for (const char* name :
       {"noise", "noise_median", "noise_p95", "denoised_noise", "clamp_light_removed"})
    metadata.erase(name);
}

void eraseLight(Metadata& metadata) {
  constexpr const char* kOfSources[] = {
      "probe",  "probe-mapping", "probe-found", "probe-rotation", "probe-scale", "files",
      "lights", "light-units",   "light-from",  "sun-angle",      "show-lights"};
  constexpr const char* kOfPaths[] = {"strategy",
                                      "mis",
                                      "guide",
                                      "regularize",
                                      "clamp",
                                      "denoise",
                                      "integrator",
                                      "ao",
                                      "reflection-occlusion",
                                      "irradiance-cache",
                                      "max-depth",
                                      "max-diffuse-depth",
                                      "max-specular-depth",
                                      "max-transmission-depth",
                                      "glass-shadows"};
  constexpr const char* kOfSamples[] = {"samples",    "samplesOfAll", "adaptive",
                                        "seed",       "shard",        "noise-limit",
                                        "time-limit", "rays",         "seconds"};
  for (const char* name : kOfSources) metadata.erase(name);
  for (const char* name : kOfPaths) metadata.erase(name);
  for (const char* name : kOfSamples) metadata.erase(name);
  for (const char* name : {"command", "aov"}) metadata.erase(name);  // of the file
}

}  // namespace chromeball
