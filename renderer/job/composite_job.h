// SPDX-License-Identifier: Apache-2.0
// The part of a render that puts objects into a photograph.
#pragma once

#include <nlohmann/json.hpp>

#include "composite/compose.h"
#include "composite/reflectance.h"
#include "composite/render_composite.h"
#include "image/io/write_image.h"
#include "job/load_scene.h"
#include "job/picture_noise.h"

namespace chromeball {

struct CompositeJob {
  Image plate;
  ObjectMask isObject;  // once the model is read
  CompositeMode mode;
  enum class Reflectance { Model, Plate, Flat } reflectance;
  std::unique_ptr<Projection> projection;  // of the reflectance, but for Model
  Passes passes;
  std::vector<Aov> layers;  // all that were asked for; the job keeps those of the first hit
};

// Reads the plate of the job's [composite] section and makes its size the picture's where no other
// is asked for. Throws InputError.
CompositeJob planComposite(RenderJob& job, bool twoPass);

// Tells objects from local scene, and gives the latter its reflectance and gloss. Throws
// InputError.
void prepareLocalScene(CompositeJob& composite, const RenderJob& job, LoadedScene& loaded);

// Says on standard error how the plate was read, where that is a guess.
void sayPlateNotes(const CompositeEntry& entry);

// What a render comes to, before it is written.
struct Rendered {
  RenderResult result;
  OutputImage output;
  PictureNoise noise;                                 // of the output
  nlohmann::json details = nlohmann::json::object();  // for the statistics
  std::vector<std::string> notes;                     // for the user
};

Rendered renderComposite(CompositeJob& composite, const RenderJob& job, const LoadedScene& loaded,
                         const World& world, const LightingStrategy& lighting,
                         const Progress& progress, const std::atomic<bool>& stop);

}  // namespace chromeball
