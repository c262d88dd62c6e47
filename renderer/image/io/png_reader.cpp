// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/work_monitor.h"
#include "image/io/sample_reader.h"

namespace chromeball {
namespace {

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
      // -1: all ancillary chunks but tRNS.
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

std::unique_ptr<SampleReader> openPng(std::span<const uint8_t> file, const CheckSize& check) {
  return std::make_unique<PngReader>(file, check);
}

}  // namespace chromeball
