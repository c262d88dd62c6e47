// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <csetjmp>
#include <cstdio>
#include <stdexcept>
#include <vector>

// needs size_t and FILE
#include <jpeglib.h>
// needs jpeglib.h
#include <jerror.h>

#include "base/progress.h"
#include "image/io/decode_image.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

// Inks as Adobe's programs store them, inverted: 255 is no ink.
void cmykToRgb(const uint8_t* cmyk, int width, uint8_t* rgb) {
  constexpr float kUnit = 1.0f / 255;
  for (; width > 0; --width, cmyk += 4, rgb += 3)
    for (int c = 0; c < 3; ++c)
      rgb[c] = uint8_t(float(cmyk[c]) * kUnit * (float(cmyk[3]) * kUnit) * 255 + 0.5f);
}

class JpegReader : public SampleReader {
 public:
  JpegReader(std::span<const uint8_t> file, const CheckSize& check) {
    jpeg_.err = jpeg_std_error(&errors_);
    jpeg_.client_data = this;
    errors_.error_exit = onError;
    errors_.emit_message = onWarning;
    progress_.progress_monitor = onProgress;
    try {
      open(file, check);
    } catch (...) {
      jpeg_destroy_decompress(&jpeg_);
      throw;
    }
  }
  ~JpegReader() override { jpeg_destroy_decompress(&jpeg_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  void read(const Row& row) override {
    guarded([&] { jpeg_start_decompress(&jpeg_); });
    std::vector<uint8_t> samples(size_t(jpeg_.output_width) * size_t(jpeg_.output_components));
    std::vector<uint8_t> rgb(isCmyk() ? size_t(layout_.width) * 3 : 0);
    uint8_t* to = samples.data();
    for (int y = 0; y < layout_.height; ++y) {
      endIfCancelled();
      guarded([&] { jpeg_read_scanlines(&jpeg_, &to, 1); });
      if (isCmyk()) cmykToRgb(samples.data(), layout_.width, rgb.data());
      row(y, isCmyk() ? rgb.data() : samples.data());
    }
  }

 private:
  void open(std::span<const uint8_t> file, const CheckSize& check) {
    guarded([&] {
      jpeg_create_decompress(&jpeg_);
      jpeg_.progress = &progress_;
      jpeg_mem_src(&jpeg_, file.data(), file.size());
      jpeg_read_header(&jpeg_, TRUE);
      isOneHuffmanScan_ = !jpeg_.arith_code && !jpeg_has_multiple_scans(&jpeg_);
    });
    if (jpeg_.num_components != 1 && jpeg_.num_components != 3 && jpeg_.num_components != 4)
      throw std::runtime_error("a JPEG has one, three or four components");
    layout_ = {int(jpeg_.image_width), int(jpeg_.image_height), jpeg_.num_components == 1 ? 1 : 3};
    if (uint64_t(layout_.width) * uint64_t(layout_.height) > file.size() * kMaxTexelsPerJpegByte)
      throw std::runtime_error(fmt::format("{} x {} texels cannot fit into {} bytes", layout_.width,
                                           layout_.height, file.size()));
    check(layout_);
  }

  bool isCmyk() const { return jpeg_.out_color_space == JCS_CMYK; }

  // Runs calls of libjpeg, which end by a jump in case of an error; so no object with a destructor
  // may live in `call`.
  template <class Call>
  void guarded(const Call& call) {
    if (setjmp(jump_)) throw std::runtime_error(error_);
    call();
  }

  static JpegReader& self(j_common_ptr jpeg) {
    return *static_cast<JpegReader*>(jpeg->client_data);
  }

  static void onError(j_common_ptr jpeg) {
    jpeg->err->format_message(jpeg, self(jpeg).error_);
    std::longjmp(self(jpeg).jump_, 1);
  }

  // libjpeg only warns of texels that the file does not have, and makes them up. Other warnings are
  // of bytes that it skips and of versions.
  static void onWarning(j_common_ptr jpeg, int level) {
    if (level >= 0) return;  // a trace
    switch (jpeg->err->msg_code) {
      case JWRN_JPEG_EOF:
        if (self(jpeg).isOneHuffmanScan_) break;  // then JWRN_HIT_MARKER tells of missing bits
        [[fallthrough]];
      case JWRN_HIT_MARKER:
      case JWRN_HUFF_BAD_CODE:
      case JWRN_ARITH_BAD_CODE:
      case JWRN_MUST_RESYNC:
        onError(jpeg);
        break;
      default:
        break;
    }
  }

  // Called at least once for each row of blocks of each scan.
  static void onProgress(j_common_ptr jpeg) {
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number <= kMaxJpegScans) return;
    std::snprintf(self(jpeg).error_, JMSG_LENGTH_MAX, "more than %d scans", kMaxJpegScans);
    std::longjmp(self(jpeg).jump_, 1);
  }

  jpeg_decompress_struct jpeg_ = {};
  jpeg_error_mgr errors_ = {};
  jpeg_progress_mgr progress_ = {};
  bool isOneHuffmanScan_ = false;
  std::jmp_buf jump_ = {};
  char error_[JMSG_LENGTH_MAX] = {};
};

}  // namespace

std::unique_ptr<SampleReader> openJpeg(std::span<const uint8_t> file, const CheckSize& check) {
  return std::make_unique<JpegReader>(file, check);
}

}  // namespace chromeball
