// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_metadata.h"

#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfEnvmapAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <string_view>

namespace chromeball {
namespace {

bool saysHowItIsStored(std::string_view name) {
  constexpr std::string_view kNames[] = {"type", "version", "chunkCount", "maxSamplesPerPixel"};
  return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

template <class T>
const T* typed(const Imf::Attribute& attribute) {
  const auto* found = dynamic_cast<const Imf::TypedAttribute<T>*>(&attribute);
  return found ? &found->value() : nullptr;
}

}  // namespace

Metadata metadataOf(const Imf::Header& header) {
  Metadata metadata;
  for (auto at = header.begin(); at != header.end(); ++at) {
    const std::string name = at.name();
    const Imf::Attribute& attribute = at.attribute();
    if (saysHowItIsStored(name)) continue;
    if (const auto* text = typed<std::string>(attribute)) {
      if (!text->empty()) metadata[name] = *text;
    } else if (const int* integer = typed<int>(attribute)) {
      metadata[name] = *integer;
    } else if (const float* number = typed<float>(attribute)) {
      metadata[name] = *number;
    } else if (const double* precise = typed<double>(attribute)) {
      metadata[name] = *precise;
    } else if (const auto* matrix = typed<Imath::M44f>(attribute)) {
      std::copy_n(matrix->getValue(), 16, std::get<Matrix44>(metadata[name] = Matrix44{}).begin());
    } else if (const auto* envmap = typed<Imf::Envmap>(attribute)) {
      if (*envmap == Imf::ENVMAP_LATLONG) metadata[name] = std::string(kEnvmapLatLong);
      if (*envmap == Imf::ENVMAP_CUBE) metadata[name] = std::string(kEnvmapCube);
    }
  }
  return metadata;
}

std::optional<Chromaticities> chromaticitiesOf(const Imf::Header& header) {
  for (auto at = header.begin(); at != header.end(); ++at)
    if (const auto* found = typed<Imf::Chromaticities>(at.attribute());
        found && std::string_view(at.name()) == "chromaticities") {
      const auto xy = [](const Imath::V2f& v) { return glm::dvec2(v.x, v.y); };
      return Chromaticities{xy(found->red), xy(found->green), xy(found->blue), xy(found->white)};
    }
  return {};
}

void setMetadata(const Metadata& metadata, Imf::Header& header) {
  for (const auto& [name, contents] : metadata) {
    if (saysHowItIsStored(name)) continue;
    if (const auto* matrix = std::get_if<Matrix44>(&contents)) {
      Imath::M44f m;
      std::copy(matrix->begin(), matrix->end(), m.getValue());
      header.insert(name, Imf::M44fAttribute(m));
    } else if (const auto* text = std::get_if<std::string>(&contents)) {
      if (name == kEnvmapAttribute && *text == kEnvmapCube)
        header.insert(name, Imf::EnvmapAttribute(Imf::ENVMAP_CUBE));
      else if (name == kEnvmapAttribute && *text == kEnvmapLatLong)
        header.insert(name, Imf::EnvmapAttribute(Imf::ENVMAP_LATLONG));
      else
        header.insert(name, Imf::StringAttribute(*text));
    } else if (const auto* number = std::get_if<float>(&contents)) {
      header.insert(name, Imf::FloatAttribute(*number));
    } else if (const auto* precise = std::get_if<double>(&contents)) {
      header.insert(name, Imf::DoubleAttribute(*precise));
    } else {
      header.insert(name, Imf::IntAttribute(std::get<int>(contents)));
    }
  }
}

}  // namespace chromeball
