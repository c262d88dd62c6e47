// SPDX-License-Identifier: Apache-2.0
#include "image/io/read_image.h"

#include <algorithm>
#include <limits>
#include <set>

#include "base/error.h"
#include "base/file.h"
#include "image/chromaticities.h"
#include "image/image.h"
#include "image/io/color_channels.h"
#include "image/io/color_space.h"
#include "image/io/decode_image.h"
#include "image/io/exif.h"
#include "image/io/exr_input.h"
#include "image/io/image_format.h"
#include "image/io/imageio_module.h"
#include "image/io/pfm.h"
#include "image/io/radiance_hdr.h"
#include "image/io/tiff.h"
#include "image/size_limits.h"
#include "image/tonemap.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

void warnOfPixels(double aspectRatio, const fs::path& path, Messages& messages) {
  if (aspectRatio == 1) return;
  addWarning(
      messages,
      "{}: its pixels are not square, {:.4g} times as wide as high; they are taken as square",
      path.string(), aspectRatio);
}

ImageFile readExr(const fs::path& path) {
  ExrInput input(path, kMaxImageFloats);
  ImageFile file = input.contents();
  warnOfPixels(input.pixelAspectRatio(), path, file.messages);
  checkImageMemory(path, input.width(), input.height(), int64_t(file.channels.size()));
  file.image = Image(input.width(), input.height(), int(file.channels.size()));
  input.read(0, input.height(), file.image.texels.data());
  return file;
}

// Multiplies the colour by alpha; the texels are linear.
void associate(Image& image, int alphaChannel) {
  for (size_t i = 0; i < image.pixels(); ++i)
    for (int c = 0; c < image.channels; ++c)
      if (c != alphaChannel) image.at(i)[c] *= image.at(i)[alphaChannel];
}

template <class Sample>
void readSamples(SampleReader& reader, const DecodeSample& decode, Image& image) {
  constexpr float kUnit = 1.0f / std::numeric_limits<Sample>::max();
  const int alpha = reader.layout().hasAlpha() ? image.channels - 1 : -1;
  std::vector<float> ofByte(sizeof(Sample) == 1 ? 256 : 0);
  for (size_t i = 0; i < ofByte.size(); ++i) ofByte[i] = decode(float(i) * kUnit);
  const auto number = [&](Sample sample) {
    return ofByte.empty() ? decode(float(sample) * kUnit) : ofByte[sample];
  };
  reader.read([&](int y, const void* samples) {
    const auto* from = static_cast<const Sample*>(samples);
    float* to = image.at(0, y);
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < image.channels; ++c, ++from)
        *to++ = c == alpha ? float(*from) * kUnit : number(*from);
  });
}

float asStored(float sample) { return sample; }

ImageFile readHdr(const fs::path& path) {
  RadianceHdr hdr = readRadianceHdr(path);
  ImageFile file{std::move(hdr.image), {"R", "G", "B"}, {}};
  // Other comments are no attributes of an .exr: they may have any name, also a reserved one.
  constexpr const char* kMapping = "mapping";  // of a probe (probe/load.h)
  if (const auto comment = hdr.comments.find(kMapping); comment != hdr.comments.end())
    file.metadata.insert(*comment);
  file.primaries = hdr.primaries;
  file.messages = std::move(hdr.messages);
  return file;
}

// Warns of a profile that is not known to state what the texels are read as: `decode`,
// `file.primaries`, in words `space`.
void warnOfProfile(std::span<const uint8_t> bytes, const DecodeSample& decode, const char* space,
                   const fs::path& path, ImageFile& file) {
  const IccProfile profile(bytes);
  if (profile.decodesBy(decode) && profile.has(file.primaries)) return;
  addWarning(file.messages,
             "{}: has a colour profile that is not applied; its colours are read as {}",
             path.string(), space);
}

// `color`: what an integer file states beside its profile and its EXIF block. Sets the file's
// primaries and, for levels, its transfer.
void readColors(PngColor color, const std::optional<std::vector<uint8_t>>& profile,
                std::span<const uint8_t> exif, IntegerTexels integers, const fs::path& path,
                ImageFile& file) {
  file.primaries = color.primaries;
  const bool isSrgb = color.transfer.value_or(Transfer::Srgb) == Transfer::Srgb && !color.primaries;
  if (integers == IntegerTexels::Levels) {
    if (profile && !color.transfer) {
      if (IccProfile(*profile).decodesBy(srgbToLinear)) color.transfer = Transfer::Srgb;
      if (IccProfile(*profile).decodesBy(asStored))
        color.transfer = Transfer::Linear, color.decode = asStored;
    }
    file.transfer = color.transfer;
  }
  if (profile) {
    const bool hasUnknownCurve = integers == IntegerTexels::Levels && !color.transfer;
    warnOfProfile(*profile, color.decode,
                  !isSrgb           ? "its gAMA or cHRM states them"
                  : hasUnknownCurve ? "those of Rec. 709"
                                    : "sRGB",
                  path, file);
  } else if (exifStatesOtherColors(exif)) {
    addWarning(file.messages,
               "{}: its EXIF states other colours than those of sRGB, such as Adobe RGB; they are "
               "read as those of sRGB",
               path.string());
  }
}

ImageFile readSampleFile(const fs::path& path, ImageFormat format, IntegerTexels integers) {
  const std::vector<uint8_t> bytes = readFile(path);
  const auto check = [&](const SampleLayout& layout) {
    checkImageSize(path, layout.width, layout.height, layout.channels);
    const uint64_t decoded =
        uint64_t(layout.width) * layout.height * layout.channels * (layout.bits / 8);
    checkFileLength(path, layout.width, layout.height, decoded, bytes.size(), kMaxDeflateRatio);
    checkImageMemory(path, layout.width, layout.height, layout.channels);
  };
  const auto reader = format == ImageFormat::Png ? openPng(bytes, check) : openJpeg(bytes, check);
  constexpr const char* kChannels[] = {"Y", "YA", "RGB", "RGBA"};
  const SampleLayout& layout = reader->layout();
  ImageFile file;
  for (const char* name = kChannels[layout.channels - 1]; *name; ++name)
    file.channels.emplace_back(1, *name);
  file.integers = true;
  file.bits = layout.bits;
  file.image = Image(layout.width, layout.height, layout.channels);
  warnOfPixels(pixelAspectRatio(bytes), path, file.messages);
  DecodeSample decode = asStored;
  if (integers != IntegerTexels::Linear) {
    const PngColor color = format == ImageFormat::Png ? pngColor(bytes) : PngColor{};
    if (integers == IntegerTexels::Srgb) decode = color.decode;
    // A PNG has chunks for what EXIF says of colours; cICP has precedence over the profile.
    if (format == ImageFormat::Jpeg)
      readColors(color, jpegProfile(bytes), bytes, integers, path, file);
    else if (pngChunk(bytes, "cICP").empty())
      readColors(color, pngProfile(bytes), {}, integers, path, file);
    else
      readColors(color, {}, {}, integers, path, file);
  }
  if (layout.bits == 8)
    readSamples<uint8_t>(*reader, decode, file.image);
  else
    readSamples<uint16_t>(*reader, decode, file.image);
  // Levels are those of the sensor: no light to be weighted by what covers the pixel.
  if (layout.hasAlpha() && integers != IntegerTexels::Levels)
    associate(file.image, layout.channels - 1);
  file.image = oriented(std::move(file.image), exifOrientation(bytes));
  return file;
}

// Reads the colour space of a TIFF of light; `file` has its kind of numbers.
void readTiffColors(std::span<const uint8_t> bytes, IntegerTexels integers, const fs::path& path,
                    ImageFile& file) {
  constexpr uint16_t kProfileTag = 34675;
  const TiffBlock tiff(bytes);
  const std::span<const uint8_t> data = tiff.bytes(tiff.firstDirectory(), kProfileTag);
  std::optional<std::vector<uint8_t>> profile;
  if (!data.empty()) profile.emplace(data.begin(), data.end());
  if (statesGrey(bytes) && file.channels == std::vector<std::string>{"R", "G", "B"})
    addWarning(
        file.messages,
        "{}: says that it is grey, but has three samples; they are read as red, green and blue",
        path.string());
  const std::optional<Chromaticities> primaries = tiffPrimaries(bytes);
  if (!file.integers) {
    file.primaries = primaries;
    if (profile) warnOfProfile(*profile, asStored, "linear Rec. 709", path, file);
    return;
  }
  readColors({.primaries = primaries}, profile, bytes, integers, path, file);
  if (hasTransferTable(bytes))
    addWarning(file.messages, "{}: has a TransferFunction that is not applied{}", path.string(),
               integers == IntegerTexels::Levels ? "" : "; its texels are read as sRGB");
}

// The file with its picture as the first image, which is the one that the module reads.
std::vector<uint8_t> withPictureFirst(std::vector<uint8_t> bytes, const fs::path& path,
                                      Messages& messages) {
  const TiffBlock tiff(bytes);
  const uint64_t picture = pictureDirectory(bytes);
  if (picture == tiff.firstDirectory()) return bytes;
  addNote(messages, "{}: its first image is a thumbnail or a mask; the first full one is read",
          path.string());
  return tiff.withFirstDirectory(picture);
}

// `isAssociated`: the codes have been multiplied by alpha (TIFF 6.0, section 18). A code above
// alpha is no such product (light of what covers nothing, or a false statement): it is decoded as
// it is, but is no darker than alpha.
void decodeSrgb(Image& image, int alphaChannel, bool isAssociated) {
  const auto channels = size_t(image.channels);
  for (size_t first = 0; first < image.texels.size(); first += channels) {
    const float alpha =
        alphaChannel >= 0 && isAssociated ? image.texels[first + size_t(alphaChannel)] : 1;
    for (size_t c = 0; c < channels; ++c) {
      float& texel = image.texels[first + c];
      if (int(c) == alphaChannel) continue;
      texel = texel < alpha ? alpha * srgbToLinear(texel / alpha)
                            : std::max(srgbToLinear(texel), alpha);
    }
  }
}

ImageFile readByModule(const fs::path& path, IntegerTexels integers) {
  ImageFile file;
  const std::vector<uint8_t> bytes =
      withStripsInside(withPictureFirst(readFile(path), path, file.messages));
  const std::unique_ptr<ModuleImage> image = openModuleImage("tiff", bytes, path);
  const ModuleImageHeader& header = image->header();
  file.channels = header.channels;
  file.integers = header.integerBits > 0;
  file.bits = header.integerBits;
  warnOfPixels(pixelAspectRatio(bytes), path, file.messages);
  if (!file.integers || integers != IntegerTexels::Linear)
    readTiffColors(bytes, integers, path, file);
  // A strip may be the whole image, which the module decodes in memory of its own; grey becomes
  // RGB.
  constexpr double kCopies = 4;
  checkImageMemory(path, header.width, header.height,
                   std::max<int64_t>(int64_t(header.channels.size()), 3), sizeof(float), kCopies);
  file.image = Image(header.width, header.height, int(header.channels.size()));
  checkDeflate(bytes);
  image->read(file.image.texels.data());
  if (file.integers && integers == IntegerTexels::Srgb)
    decodeSrgb(file.image, header.alphaChannel, !header.unassociatedAlpha && statesAlpha(bytes));
  if (header.unassociatedAlpha && !(file.integers && integers == IntegerTexels::Levels))
    associate(file.image, header.alphaChannel);
  file.image = oriented(std::move(file.image), exifOrientation(bytes));
  return file;
}

// Whether the file has a colour of three channels, which its primaries are those of.
bool hasConvertedColor(const ImageFile& file) {
  const PartChannels part{file.part, file.channels};
  if (const auto color = findColorChannels({&part, 1}); color && color->channels.size() == 3)
    return true;
  const std::set<std::string> channels(file.channels.begin(), file.channels.end());
  const auto has = [&](const std::string& channel) { return channels.contains(channel); };
  return std::ranges::any_of(layerNames(file), [&](const std::string& layer) {
    return isColorLayer(layer) && has(layer + ".R") && has(layer + ".G") && has(layer + ".B");
  });
}

}  // namespace

std::optional<double> metadataNumber(const Metadata& metadata, const std::string& name) {
  const auto found = metadata.find(name);
  if (found == metadata.end()) return {};
  return std::visit(
      [](const auto& value) -> std::optional<double> {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) return value;
        return {};
      },
      found->second);
}

Metadata readExrMetadata(const fs::path& path) {
  return ExrInput(path, kMaxImageFloats).contents().metadata;
}

ImageFile readImageFile(const fs::path& path, IntegerTexels integers) {
  const ImageFormat format = imageFormat(path);
  ImageFile file = readByLibrary(path, [&]() -> ImageFile {
    switch (format) {
      case ImageFormat::Exr:
        return readExr(path);
      case ImageFormat::RadianceHdr:
        return readHdr(path);
      case ImageFormat::Pfm: {
        ImageFile pfm;
        pfm.image = readPfm(path, pfm.messages);
        pfm.channels = pfm.image.channels == 1 ? std::vector<std::string>{"Y"}
                                               : std::vector<std::string>{"R", "G", "B"};
        return pfm;
      }
      case ImageFormat::Png:
      case ImageFormat::Jpeg:
        return readSampleFile(path, format, integers);
      case ImageFormat::Tiff:
        return readByModule(path, integers);
      default:
        throwUnreadable(path, "it is not an EXR, Radiance HDR, PFM, PNG, JPEG or TIFF file");
    }
  });
  if (file.primaries && !toRec709(*file.primaries))
    throwInput(
        "{}: its primaries are degenerate: red ({}, {}), green ({}, {}), blue ({}, {}), white ({}, "
        "{})",
        path.string(), file.primaries->red.x, file.primaries->red.y, file.primaries->green.x,
        file.primaries->green.y, file.primaries->blue.x, file.primaries->blue.y,
        file.primaries->white.x, file.primaries->white.y);
  if (file.primaries && !isRec709(*file.primaries) && hasConvertedColor(file))
    file.messages.push_back(conversionNote(path, *file.primaries));
  return file;
}

Image readImage(const fs::path& path, IntegerTexels integers, Messages* messages) {
  ImageFile file = readImageFile(path, integers);
  if (messages) messages->insert(messages->end(), file.messages.begin(), file.messages.end());
  return colorOf(std::move(file), path);
}

}  // namespace chromeball
