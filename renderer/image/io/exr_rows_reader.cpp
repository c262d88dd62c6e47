// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_rows_reader.h"

#include <array>
#include <fstream>
#include <thread>

#include "base/file.h"
#include "image/io/exr_input.h"
#include "image/io/image_format.h"
#include "image/io/unreadable.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<ExrInput> openRows(const fs::path& path, uint64_t maxNumbers) {
  checkReadable(path);
  std::array<char, kFormatBytes> magic{};
  std::ifstream(path, std::ios::binary).read(magic.data(), magic.size());
  if (imageFormat({reinterpret_cast<const uint8_t*>(magic.data()), magic.size()}) !=
      ImageFormat::Exr)
    throwUnreadable(path, "it is not an EXR file");
  auto input = std::make_unique<ExrInput>(path, maxNumbers);
  if (input->isTiled())
    throwUnreadable(path, "deep, volume and tiled images are not supported here");
  if (input->numbers() != ExrInput::Numbers::Half && input->numbers() != ExrInput::Numbers::Float)
    throwUnreadable(path, "its channels should be all of 32 or all of 16 bits, not integers");
  return input;
}

}  // namespace

ExrRowsReader::ExrRowsReader(const fs::path& path, uint64_t maxNumbers)
    : input_(openRows(path, maxNumbers)) {}

ExrRowsReader::ExrRowsReader(ExrRowsReader&&) noexcept = default;
ExrRowsReader::~ExrRowsReader() = default;

int ExrRowsReader::width() const { return input_->width(); }
int ExrRowsReader::height() const { return input_->height(); }
const std::vector<std::string>& ExrRowsReader::channels() const { return input_->channels(); }
const Metadata& ExrRowsReader::metadata() const { return input_->metadata(); }

const std::optional<Placement>& ExrRowsReader::placement() const { return input_->placement(); }
const std::optional<Chromaticities>& ExrRowsReader::primaries() const {
  return input_->primaries();
}

Image ExrRowsReader::read(int top, int count) {
  Image rows(width(), count, int(channels().size()));
  input_->read(top, count, rows.texels.data());
  return rows;
}

// Of OpenEXR two blocks a thread, with their compression.
double ExrRowsReader::bufferBytes() const {
  const double row = double(sizeof(float)) * width() * double(channels().size());
  return row * 2.0 * std::thread::hardware_concurrency() * 3 * input_->rowsOfBlock();
}

}  // namespace chromeball
