// SPDX-License-Identifier: Apache-2.0
#include "image/io/color_space.h"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <map>
#include <stdexcept>
#include <vector>

#include "base/progress.h"
#include "image/io/decode_image.h"
#include "image/io/exif.h"
#include "image/io/image_format.h"

namespace chromeball {
namespace {

// Numbers of chunks are multiples of 1/100000.
template <size_t kCount>
std::optional<std::array<double, kCount>> numbersIn(std::span<const uint8_t> chunk) {
  if (chunk.size() != 4 * kCount) return {};
  std::array<double, kCount> numbers;
  for (size_t i = 0; i < kCount; ++i)
    numbers[i] = double(bigEndian(chunk.subspan(4 * i, 4))) / 100000;
  return numbers;
}

DecodeSample powerCurve(double exponent) {
  return [exponent](float sample) { return float(std::pow(double(sample), exponent)); };
}

// The inverse of the cameras' curve, with its constants of ITU-T H.273.
float rec709ToLinear(float sample) {
  constexpr double kAlpha = 1.099296826809442, kBeta = 0.018053968510807;
  if (sample < 4.5 * kBeta) return float(sample / 4.5);
  return float(std::pow(double(float((sample + (kAlpha - 1)) / kAlpha)), 1 / 0.45));
}

// Code points of ITU-T H.273, tables 2 and 3.

std::optional<Chromaticities> primariesOf(uint8_t code) {
  constexpr glm::dvec2 kD65(0.3127, 0.329), kDci(0.314, 0.351);
  constexpr Chromaticities kNtsc{{0.63, 0.34}, {0.31, 0.595}, {0.155, 0.07}, kD65};
  static const std::map<uint8_t, std::optional<Chromaticities>> kPrimaries = {
      {1, {}},                                                             // Rec. 709
      {2, {}},                                                             // unspecified
      {5, Chromaticities{{0.64, 0.33}, {0.29, 0.6}, {0.15, 0.06}, kD65}},  // Rec. 601
      {6, kNtsc},                                                          // of 525 lines
      {7, kNtsc},
      {9, Chromaticities{{0.708, 0.292}, {0.17, 0.797}, {0.131, 0.046}, kD65}},  // Rec. 2020
      {11, Chromaticities{{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, kDci}},     // DCI-P3
      {12, Chromaticities{{0.68, 0.32}, {0.265, 0.69}, {0.15, 0.06}, kD65}}};    // Display P3
  const auto found = kPrimaries.find(code);
  if (found == kPrimaries.end())
    throw std::runtime_error(
        fmt::format("its cICP chunk states primaries that are not known here, {}", code));
  return found->second;
}

PngColor transferOf(uint8_t code) {
  static const std::map<uint8_t, PngColor> kTransfers = {
      {1, {rec709ToLinear, {}, Transfer::Other}},  // Rec. 709, 601 and 2020
      {2, {srgbToLinear, {}, {}}},                 // unspecified
      {4, {powerCurve(2.2), {}, Transfer::Other}},
      {5, {powerCurve(2.8), {}, Transfer::Other}},
      {6, {rec709ToLinear, {}, Transfer::Other}},
      {8, {[](float sample) { return sample; }, {}, Transfer::Linear}},
      {13, {srgbToLinear, {}, Transfer::Srgb}},
      {14, {rec709ToLinear, {}, Transfer::Other}},
      {15, {rec709ToLinear, {}, Transfer::Other}}};
  const auto found = kTransfers.find(code);
  if (found == kTransfers.end())
    throw std::runtime_error(fmt::format(
        "its cICP chunk states {}, which is not decoded here: convert it to linear .exr or .hdr",
        code == 16   ? "the transfer PQ (SMPTE ST 2084)"
        : code == 18 ? "the transfer HLG (ARIB STD-B67)"
                     : fmt::format("a transfer that is not known, {}", code)));
  return found->second;
}

PngColor colorOfCodePoints(std::span<const uint8_t> chunk) {
  const uint8_t matrix = chunk[2], fullRange = chunk[3];
  if (matrix != 0 || fullRange != 1)
    throw std::runtime_error(
        "its cICP chunk states samples that are not RGB of the full range, which are not decoded "
        "here");
  PngColor color = transferOf(chunk[1]);
  color.primaries = primariesOf(chunk[0]);
  return color;
}

static_assert(std::endian::native == std::endian::little);

class PngReader : public SampleReader {
 public:
  PngReader(std::span<const uint8_t> file, const CheckSize& check) : rest_(file) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, onError, onWarning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    try {
      if (!info_) throw std::bad_alloc();
      open(file.size(), check);
    } catch (...) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw;
    }
  }
  ~PngReader() override { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  void read(const Row& row) override {
    const size_t rowBytes =
        size_t(layout_.width) * size_t(layout_.channels) * size_t(layout_.bits / 8);
    const int rowsAtOnce = passes_ > 1 ? layout_.height : 1;
    std::vector<uint8_t> rows(rowBytes * size_t(rowsAtOnce));
    const auto at = [&](int y) { return rows.data() + (passes_ > 1 ? rowBytes * size_t(y) : 0); };
    for (int pass = 0; pass < passes_; ++pass)
      for (int y = 0; y < layout_.height; ++y) {
        endIfCancelled();
        guarded([&] { png_read_row(png_, at(y), nullptr); });
        if (passes_ == 1) row(y, rows.data());
      }
    if (passes_ == 1) return;
    for (int y = 0; y < layout_.height; ++y) row(y, at(y));
  }

 private:
  void open(size_t fileBytes, const CheckSize& check) {
    guarded([&] {
      png_set_read_fn(png_, this, readBytes);
      // The caller checks the size; no chunk is longer than the file.
      png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
      png_set_chunk_malloc_max(png_, fileBytes);
      // -1 means all ancillary chunks but tRNS.
      png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
      png_read_info(png_, info_);
    });
    const int color = png_get_color_type(png_, info_);
    const bool hasColor = color & PNG_COLOR_MASK_COLOR;
    const bool hasAlpha = color & PNG_COLOR_MASK_ALPHA || png_get_valid(png_, info_, PNG_INFO_tRNS);
    layout_ = {int(png_get_image_width(png_, info_)), int(png_get_image_height(png_, info_)),
               (hasColor ? 3 : 1) + (hasAlpha ? 1 : 0),
               png_get_bit_depth(png_, info_) == 16 ? 16 : 8};
    check(layout_);
    guarded([&] {
      png_set_expand(png_);
      png_set_swap(png_);  // 16 bits are big-endian in the file
      passes_ = png_set_interlace_handling(png_);
      png_read_update_info(png_, info_);
    });
  }

  // Runs calls of libpng, which end by a jump in case of an error; so no object with a destructor
  // may live in `call`.
  template <class Call>
  void guarded(const Call& call) {
    if (setjmp(png_jmpbuf(png_))) throw std::runtime_error(error_);
    call();
  }

  static void onError(png_structp png, png_const_charp message) {
    auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(reader.error_, message, sizeof(reader.error_) - 1);
    png_longjmp(png, 1);
  }
  static void onWarning(png_structp, png_const_charp) {}

  static void readBytes(png_structp png, png_bytep to, size_t count) {
    auto& rest = static_cast<PngReader*>(png_get_io_ptr(png))->rest_;
    if (count > rest.size()) png_error(png, "the file ends before the image");
    std::memcpy(to, rest.data(), count);
    rest = rest.subspan(count);
  }

  std::span<const uint8_t> rest_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;
  char error_[256] = {};
};

}  // namespace

PngColor pngColor(std::span<const uint8_t> file) {
  constexpr size_t kCodePoints = 4;
  if (const auto chunk = pngChunk(file, "cICP"); chunk.size() == kCodePoints)
    return colorOfCodePoints(chunk);
  if (!pngChunk(file, "sRGB").empty()) return {.transfer = Transfer::Srgb};
  PngColor color;
  if (const auto gamma = numbersIn<1>(pngChunk(file, "gAMA")); gamma && (*gamma)[0] > 0) {
    // Writers of sRGB state 1/2.2, a power near its curve.
    constexpr double kOfSrgb = 1 / 2.2, kTolerance = 0.05;
    const double exponent = 1 / (*gamma)[0];
    const bool isSrgb = std::abs((*gamma)[0] / kOfSrgb - 1) <= kTolerance;
    color.transfer = isSrgb ? Transfer::Srgb : exponent == 1 ? Transfer::Linear : Transfer::Other;
    if (!isSrgb) color.decode = powerCurve(exponent);
  }
  if (const auto n = numbersIn<8>(pngChunk(file, "cHRM")))
    color.primaries = Chromaticities{
        {(*n)[2], (*n)[3]}, {(*n)[4], (*n)[5]}, {(*n)[6], (*n)[7]}, {(*n)[0], (*n)[1]}};
  return color;
}

std::unique_ptr<SampleReader> openPng(std::span<const uint8_t> file, const CheckSize& check) {
  return std::make_unique<PngReader>(file, check);
}

}  // namespace chromeball
