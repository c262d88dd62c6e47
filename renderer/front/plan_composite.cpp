// SPDX-License-Identifier: Apache-2.0
#include "front/plan_render.h"

#include <algorithm>

#include "base/error.h"
#include "composite/plate.h"

namespace chromeball {
namespace {

using Reflectance = CompositeDescription::Reflectance;

void planReflectance(const Settings& s, RenderDescription& description) {
  CompositeDescription& composite = *description.composite;
  if (s.has("composite.reflectance")) {
    composite.reflectance = s.choice<Reflectance>("composite.reflectance");
  } else if (s.get<bool>("composite.ground")) {
    const bool isSimple = composite.entry.localScene.empty() && !description.surroundings &&
                          description.lamps.empty();
    composite.reflectance = isSimple ? Reflectance::Flat : Reflectance::Plate;
    composite.choosesReflectance = true;
  }
}

// The layers that a compositor needs are always written: plate x (1 - alpha) x ratio + objects, or
// plate x (1 - alpha) + objects + difference.
void planShadowCatcher(const Settings& s, RenderDescription& description) {
  CompositeDescription& composite = *description.composite;
  composite.mode = CompositeMode::ShadowCatcher;
  if (s.has("composite.plate"))
    throwInput("{}: a shadow catcher is rendered without `plate`; leave one of them out",
               s.location("composite.plate"));
  for (const char* key : {"reflectance", "iterations"})
    if (const std::string name = fmt::format("composite.{}", key); s.has(name))
      throwInput("{}: a shadow catcher has no plate that tells its reflectance", s.location(name));
  if (std::ranges::count(composite.layers, "reflectance") > 0)
    throwInput("{}: a shadow catcher has no plate that tells the layer `reflectance`",
               s.location("output.aovs"));
  for (const char* layer : {"objects", "alpha", "difference", "ratio"})
    if (std::ranges::count(composite.layers, layer) == 0) composite.layers.emplace_back(layer);
}

void planPlate(const Settings& s, RenderDescription& description) {
  CompositeDescription& composite = *description.composite;
  composite.mode = s.choice<CompositeMode>("composite.mode");
  composite.plateFile = s.get<std::string>("composite.plate");
  Messages decoding;
  const Image plate = readPlate(*composite.plateFile, &composite.messages, &decoding);
  composite.isPhotograph = !decoding.empty();
  composite.messages.insert(composite.messages.end(), decoding.begin(), decoding.end());
  if (std::optional<vec4>& part = composite.entry.groundInPlate) {
    const vec4 whole(plate.width, plate.height, plate.width, plate.height);
    if (part->z > whole.z || part->w > whole.w)
      throwInput("{}: `ground_in_plate` is not inside the plate, {} of {}x{} pixels",
                 description.origins.of("composite.ground_in_plate"), *composite.plateFile,
                 plate.width, plate.height);
    *part /= whole;
  }
  std::optional<ImageSize>& size = description.size;
  if (!size) size = ImageSize{plate.width, plate.height};
  composite.plate = scaledPlate(plate, size->width, size->height, *composite.plateFile);

  planReflectance(s, description);
  composite.iterations = int(s.get<uint64_t>("composite.iterations"));
  if (s.has("composite.iterations") && composite.reflectance != Reflectance::Plate)
    throwInput("{}: `iterations` is only for reflectance = \"plate\"",
               s.location("composite.iterations"));
  if (std::ranges::count(composite.layers, "reflectance") > 0 &&
      composite.reflectance == Reflectance::Model)
    throwInput("{}: layer `reflectance` needs reflectance = \"plate\" or \"flat\" in [composite]",
               s.location("output.aovs"));
}

}  // namespace

void planComposite(const Settings& s, CompositeEntry entry, RenderDescription& description) {
  using enum CompositeDescription::GroundPlane;
  CompositeDescription& composite = description.composite.emplace();
  composite.entry = std::move(entry);
  composite.layers = s.get<std::vector<std::string>>("output.aovs");
  composite.passes = s.get<bool>("two-pass") ? Passes::Two : Passes::One;
  composite.ground = s.get<bool>("composite.ground") ? Always
                     : s.has("shadow-catcher")       ? IfNamed
                                                     : Never;
  composite.groundHeight = s.get<double>("composite.ground_height");
  composite.specular = s.getIfGiven<double>("composite.specular");
  composite.roughness = s.getIfGiven<double>("composite.roughness");
  isShadowCatcher(s) ? planShadowCatcher(s, description) : planPlate(s, description);
  std::erase(description.settings.aovs, Aov::Alpha);  // a composite's alpha is a layer of its own
}

}  // namespace chromeball
