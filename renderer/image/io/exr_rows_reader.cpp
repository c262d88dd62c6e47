// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_rows_reader.h"

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

void checkMagic(const fs::path& path) {
  checkReadable(path);
  std::array<char, 4> magic{};
  std::ifstream(path, std::ios::binary).read(magic.data(), magic.size());
  const char* reader = readerFor({reinterpret_cast<const uint8_t*>(magic.data()), magic.size()});
  if (!reader || reader != std::string_view(kReader))
    throwUnreadable(path, "it is not an EXR file");
}

}  // namespace

class ExrRowsReader::Input {
 public:
  Input(const fs::path& path) : path_(path), file_(openImage(kReader, path.string())) {
    const OIIO::ImageSpec& spec = file_->spec();
    if (spec.deep || spec.depth > 1 || spec.tile_width > 0)
      throwUnreadable(path, "deep, volume and tiled images are not supported here");
    checkFileLength(path, kReader, spec);
  }

  const OIIO::ImageSpec& spec() const { return file_->spec(); }

  void read(int top, Image& rows) {
    const int y = spec().y + top;
    if (!file_->read_scanlines(0, 0, y, y + rows.height, 0, 0, rows.channels, OIIO::TypeDesc::FLOAT,
                               rows.texels.data()))
      throwUnreadable(path_, file_->geterror());
  }

 private:
  fs::path path_;
  std::unique_ptr<OIIO::ImageInput> file_;
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
  readByOiio(path_, [&] { input_->read(top, rows); });
  return rows;
}

// Texels that OpenImageIO converts; and of OpenEXR two blocks a thread, with their compression.
double ExrRowsReader::bufferBytes() const {
  constexpr double kConverted = 64 << 20;
  const double block = double(sizeof(float)) * width_ * double(channels_.size()) * rowsOfBlock_;
  return kConverted + 2.0 * std::thread::hardware_concurrency() * 3 * block;
}

}  // namespace chromeball
