// SPDX-License-Identifier: Apache-2.0
#include "study/reference.h"

#include "base/error.h"
#include "image/io/read_image.h"

namespace chromeball {
namespace {

// The mean of independent parts, with its squared standard error from their variance.
Reference meanOfParts(const std::vector<Image>& parts) {
  Reference reference{parts[0], parts[0]};
  for (size_t i = 0; i < parts[0].texels.size(); ++i) {
    std::vector<double> numbers;
    for (const Image& part : parts) numbers.push_back(part.texels[i]);
    const Estimate e = meanOf(numbers);
    reference.mean.texels[i] = float(e.mean);
    reference.squaredError.texels[i] = float(e.standardError * e.standardError);
  }
  return reference;
}

Reference readReference(const std::string& path, int width, int height, Messages* messages) {
  const ImageFile file = readImageFile(path);
  if (messages) messages->insert(messages->end(), file.messages.begin(), file.messages.end());
  std::optional<Image> color = findColor(file);
  if (!color) throwInput("--reference: {}: has no colour", path);
  color = inDisplayWindow(*std::move(color), file.placement, path);
  if (color->width != width || color->height != height)
    throwInput("--reference: {} is {} x {}, but the renders are {} x {}; try --size {}x{}", path,
               color->width, color->height, width, height, color->width, color->height);
  const std::optional<Image> variance = layerOf(file, "variance", path);
  return {*color, variance && variance->channels == 3 ? *variance : Image()};
}

}  // namespace

Reference loadReference(const Study& study, const RenderStore& store, int width, int height,
                        Messages* messages) {
  if (!study.referenceFile.empty())
    return readReference(study.referenceFile, width, height, messages);
  std::vector<Image> parts;
  for (int part = 0; part < Study::kReferenceParts; ++part)
    parts.push_back(store.find(study.referencePart(part)).value().image);
  return meanOfParts(parts);
}

}  // namespace chromeball
