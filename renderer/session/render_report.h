// SPDX-License-Identifier: Apache-2.0
// The statistics of a render, and the attributes of its EXR file.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string>

#include "base/message.h"
#include "description/render_description.h"
#include "session/render_loaded.h"

namespace chromeball {

// Seconds that the phases of a description take.
struct PhaseSeconds {
  double load = 0, build = 0, prepare = 0, render = 0, write = 0;
};

// The statistics of `chromeball render --stats`: the description (description/describe.h), samples,
// rays, seconds, noise, memory. Numbers that are unknown are null.
nlohmann::json statistics(const LoadedScene& loaded, const FinishedRender& result,
                          const PhaseSeconds& seconds);

// The attributes of the EXR file: the description, and the noise, samples, rays and seconds of the
// render.
Metadata imageMetadata(const LoadedScene& loaded, const FinishedImage& finished,
                       const RenderResult& render, double seconds);

// The attributes that depend on the samples.
Metadata sampleMetadata(const FinishedImage& finished, const RenderResult& render);

// Adds the noise of a denoised image to the attributes.
void addNoise(const DenoiseReport& denoised, Metadata& metadata);

// The output files of a description: images and statistics.

// Checks, before rendering, that the outputs can be written. Returns warnings about settings that
// have no effect. Throws InputError or RunError.
Messages checkOutputs(const RenderDescription& description);

// The name under which an image is saved that has no samples in some pixels.
std::string partialName(const std::string& output);

// Call when all files are read (`inputs`; the scene file itself is added) and no other input error
// can occur. Throws InputError if an output would overwrite an input, and makes the folders that
// the scene file names for its images.
void prepareOutputs(const RenderDescription& description, std::vector<std::string> inputs);

// The machine, the program and the date of a measurement.

struct Machine {
  std::string processor, system, compiler, date;  // date: UTC
  int threads = 0;                                // used by this run
  std::string command;                            // quoted for a shell
};
Machine thisMachine();

uint64_t peakMemoryBytes();  // of this process so far; 0 if the system does not tell

}  // namespace chromeball
