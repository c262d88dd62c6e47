// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_rows_reader.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <thread>

#include "base/file.h"
#include "image/io/exr_header.h"
#include "image/io/oiio_file.h"
#include "image/io/oiio_reader.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReader = "openexr";
constexpr int64_t kFloatsReadAtOnce = int64_t(1) << 24;

void checkMagic(const fs::path& path) {
  checkReadable(path);
  std::array<char, 4> magic{};
  std::ifstream(path, std::ios::binary).read(magic.data(), magic.size());
  const char* reader = readerFor({reinterpret_cast<const uint8_t*>(magic.data()), magic.size()});
  if (!reader || reader != std::string_view(kReader))
    throwUnreadable(path, "it is not an EXR file");
}

}  // namespace

// ImageInput::read_scanlines() makes a copy, of 256 rows even where fewer are read.
class ExrRowsReader::Input {
 public:
  Input(const fs::path& path) : path_(path), file_(openImage(kReader, path.string())) {
    if (spec().deep || spec().depth > 1 || spec().tile_width > 0)
      throwUnreadable(path, "deep, volume and tiled images are not supported here");
    if (!spec().channelformats.empty() || !(isFloat() || spec().format == OIIO::TypeDesc::HALF))
      throwUnreadable(path, "its channels should be all of 32 or all of 16 bits, not integers");
    checkFileLength(path, kReader, spec());
  }

  const OIIO::ImageSpec& spec() const { return file_->spec(); }
  bool isFloat() const { return spec().format == OIIO::TypeDesc::FLOAT; }

  void read(int top, int count, float* texels) {
    if (isFloat()) return readNative(top, count, texels);
    halves_.resize(size_t(count) * spec().scanline_bytes(true));
    readNative(top, count, halves_.data());
    OIIO::parallel_convert_image(spec().nchannels, spec().width, count, 1, halves_.data(),
                                 OIIO::TypeDesc::HALF, OIIO::AutoStride, OIIO::AutoStride,
                                 OIIO::AutoStride, texels, OIIO::TypeDesc::FLOAT, OIIO::AutoStride,
                                 OIIO::AutoStride, OIIO::AutoStride);
  }

 private:
  void readNative(int top, int count, void* texels) {
    const int begin = spec().y + top;
    if (!file_->read_native_scanlines(0, 0, begin, begin + count, 0, texels))
      throwUnreadable(path_, file_->geterror());
  }

  fs::path path_;
  std::unique_ptr<OIIO::ImageInput> file_;
  std::vector<uint8_t> halves_;
};

ExrRowsReader::ExrRowsReader(const fs::path& path, uint64_t maxNumbers) : path_(path) {
  checkMagic(path);
  rowsOfBlock_ = checkExrHeaders(path, maxNumbers);
  input_ = readByOiio(path, [&] { return std::make_unique<Input>(path); });
  const OIIO::ImageSpec& spec = input_->spec();
  width_ = spec.width, height_ = spec.height;
  channels_ = spec.channelnames;
  metadata_ = metadataOf(spec);
}

ExrRowsReader::ExrRowsReader(ExrRowsReader&&) noexcept = default;
ExrRowsReader::~ExrRowsReader() = default;

Image ExrRowsReader::read(int top, int count) {
  Image rows(width_, count, int(channels_.size()));
  const int most = rowsAtOnce();
  readByOiio(path_, [&] {
    for (int y = 0; y < count; y += most)
      input_->read(top + y, std::min(most, count - y), rows.at(0, y));
  });
  return rows;
}

// Whole blocks of compression, of about kFloatsReadAtOnce.
int ExrRowsReader::rowsAtOnce() const {
  const int64_t block = int64_t(width_) * int64_t(channels_.size()) * rowsOfBlock_;
  return rowsOfBlock_ * int(std::clamp<int64_t>(kFloatsReadAtOnce / block, 1, height_));
}

// The rows at once, as halves; and of OpenEXR two blocks a thread, with their compression.
double ExrRowsReader::bufferBytes() const {
  const double row = double(sizeof(float)) * width_ * double(channels_.size());
  return row * (0.5 * rowsAtOnce() + 2.0 * std::thread::hardware_concurrency() * 3 * rowsOfBlock_);
}

}  // namespace chromeball
