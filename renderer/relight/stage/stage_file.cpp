// SPDX-License-Identifier: Apache-2.0
#include "relight/stage/stage_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "base/error.h"
#include "base/text.h"
#include "image/chromaticities.h"

namespace chromeball {
namespace {

constexpr const char* kBasisName = "basis";  // the attribute
constexpr const char* kOwn = "own";

std::string layerName(int element) { return fmt::format("element.{:04}", element); }

void addChannels(std::vector<std::string>& names, const std::string& layer) {
  for (const char* letter : {".R", ".G", ".B"}) names.push_back(layer + letter);
}

std::vector<std::string> channelNames(const DirectionBasis& basis) {
  std::vector<std::string> names;
  for (int i = 0; i < basis.size(); ++i) addChannels(names, layerName(i));
  return names;
}

ExrLayout layoutOf(const LightStage& like, int height, Metadata metadata, bool halves) {
  metadata[kBasisName] = like.basis.name();
  std::vector<std::string> channels{"R", "G", "B"};
  std::ranges::move(channelNames(like.basis), std::back_inserter(channels));
  if (!like.own.empty()) addChannels(channels, kOwn);
  return {.width = like.width(),
          .height = height,
          .channels = std::move(channels),
          .metadata = std::move(metadata),
          .halves = halves,
          .separateRows = true};
}

DirectionBasis basisOf(const std::filesystem::path& path, const Metadata& metadata) {
  const auto found = metadata.find(kBasisName);
  const auto* name = found == metadata.end() ? nullptr : std::get_if<std::string>(&found->second);
  if (!name) throwInput("{}: is not a light stage; `chromeball basis` writes one", path.string());
  return {printable(*name), path.string()};  // which quotes what it does not know
}

// The channels with these names; nullopt if one is missing.
std::optional<std::vector<size_t>> positions(const std::vector<std::string>& channels,
                                             const std::vector<std::string>& names) {
  std::unordered_map<std::string, size_t> byName;
  for (size_t i = 0; i < channels.size(); ++i) byName[channels[i]] = i;
  std::vector<size_t> found;
  for (const std::string& name : names) {
    const auto at = byName.find(name);
    if (at == byName.end()) return std::nullopt;
    found.push_back(at->second);
  }
  return found;
}

Image extract(const Image& all, const std::vector<size_t>& channels) {
  Image part(all.width, all.height, int(channels.size()));
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x)
      for (size_t c = 0; c < channels.size(); ++c) part.at(x, y)[c] = all.at(x, y)[channels[c]];
  return part;
}

// Does the same in place: a pixel's channels move to the front, so that the image never exists
// twice.
Image extract(Image&& all, const std::vector<size_t>& channels) {
  std::vector<float> pixel(channels.size());
  const size_t pixels = size_t(all.width) * size_t(all.height), stride = size_t(all.channels);
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < pixel.size(); ++c) pixel[c] = all.texels[i * stride + channels[c]];
    std::copy(pixel.begin(), pixel.end(), all.texels.begin() + ptrdiff_t(i * pixel.size()));
  }
  all.channels = int(channels.size());
  all.texels.resize(pixels * channels.size());
  return std::move(all);
}

// All triples of channels.
void convertColors(Image& image, const glm::dmat3& matrix) {
  for (size_t i = 0; i + 2 < image.texels.size(); i += 3) {
    float* color = &image.texels[i];
    const dvec3 converted = matrix * dvec3(color[0], color[1], color[2]);
    for (int c = 0; c < 3; ++c) color[c] = float(converted[c]);
  }
}

// `top`: the image's first row in the stage.
void checkFinite(const std::filesystem::path& path, const Image& image, int top) {
  for (size_t i = 0; i < image.texels.size(); ++i)
    if (!std::isfinite(image.texels[i])) {
      const size_t pixel = i / size_t(image.channels);
      throwInput("{}: pixel {}, {} has values that are not finite", path.string(),
                 pixel % size_t(image.width), size_t(top) + pixel / size_t(image.width));
    }
}

}  // namespace

StageWriter::StageWriter(const std::filesystem::path& path, const LightStage& like, int height,
                         Metadata metadata, bool halves)
    : file_(path, layoutOf(like, height, std::move(metadata), halves)) {}

void StageWriter::write(const LightStage& band, const Image& color) {
  std::vector<const Image*> images{&color, &band.elements};
  if (!band.own.empty()) images.push_back(&band.own);
  file_.write(images);
}

double StageWriter::bufferBytes(const DirectionBasis& basis, int width) {
  return ExrRowsWriter::bufferBytes(width, size_t(stageChannels(basis)));
}

StageReader::StageReader(const std::filesystem::path& path)
    : path_(path), file_(path, kMaxStageNumbers), basis_(basisOf(path, file_.contents().metadata)) {
  const auto elements = positions(file_.channels(), channelNames(basis_));
  if (!elements)
    throwInput("{}: lacks elements of its basis {}, which has {}", path.string(), basis_.name(),
               basis_.size());
  if (file_.contents().placement)
    throwInput(
        "{}: its data window is not its display window: it was cropped or extended after it was "
        "made; a light stage has all pixels of its picture",
        path.string());
  if (const auto& primaries = file_.contents().primaries; primaries && !isRec709(*primaries)) {
    toRec709_ = toRec709(*primaries);
    if (!toRec709_) throwInput("{}: its primaries are degenerate", path.string());
    messages_.push_back(conversionNote(path, *primaries));
  }
  elements_ = *elements;
  std::vector<std::string> own;
  addChannels(own, kOwn);
  own_ = positions(file_.channels(), own).value_or(std::vector<size_t>());
}

LightStage StageReader::read(int top, int count) {
  Image all = file_.read(top, count);
  LightStage band{basis_, {}, {}};
  if (!own_.empty()) band.own = extract(all, own_);
  band.elements = extract(std::move(all), elements_);
  if (toRec709_) {
    convertColors(band.own, *toRec709_);
    convertColors(band.elements, *toRec709_);
  }
  checkFinite(path_, band.elements, top);
  checkFinite(path_, band.own, top);
  return band;
}

double StageReader::rowBytes() const {
  return double(sizeof(float)) * width() * double(file_.channels().size() + own_.size());
}

StageBands::StageBands(LightStage whole)
    : band_(std::move(whole)), top_(0), rows_(band_.height()) {}

StageBands::StageBands(StageReader file, double memory, std::string_view location)
    : file_(std::move(file)), band_{file_->basis(), {}, {}} {
  const double rows = (memory - file_->bufferBytes()) / file_->rowBytes();
  if (rows < 1)
    throwInput(
        "{}: a row of {} pixels with {} elements takes {:.3g} GB of memory; {:.3g} GB are left",
        location, width(), basis().size(), 1e-9 * (file_->rowBytes() + file_->bufferBytes()),
        1e-9 * std::max(memory, 0.0));
  rows_ = int(std::min(rows, double(height())));
}

void StageBands::forEach(const std::function<void(const LightStage& band, int top)>& visit) {
  for (int top = 0; top < height(); top += rows_) {
    read(top);
    visit(band_, top);
  }
}

LightStage StageBands::row(int y) {
  if (file_) return file_->read(y, 1);
  LightStage row{band_.basis, Image(width(), 1, band_.elements.channels), {}};
  std::copy_n(band_.elements.at(0, y), row.elements.texels.size(), row.elements.texels.data());
  return row;
}

void StageBands::read(int top) {
  if (top == top_) return;
  band_.elements = {}, band_.own = {};  // before the next is allocated
  band_ = file_->read(top, std::min(rows_, height() - top));
  top_ = top;
}

}  // namespace chromeball
