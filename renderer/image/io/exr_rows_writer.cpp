// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_rows_writer.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <thread>

#include "base/atomic_file.h"
#include "base/error.h"
#include "image/io/exr_state.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kFloatsWrittenAtOnce = int64_t(1) << 24;

OIIO::ImageSpec specOf(const ExrLayout& layout) {
  OIIO::ImageSpec spec(layout.width, layout.height, int(layout.channels.size()),
                       layout.halves ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
  spec.channelnames = layout.channels;
  spec.attribute("compression", layout.separateRows ? "zips" : "zip");
  for (const auto& [name, contents] : layout.metadata)
    if (const auto* matrix = std::get_if<Matrix44>(&contents))
      spec.attribute(name, OIIO::TypeMatrix, matrix->data());
    else if (const auto* text = std::get_if<std::string>(&contents))
      spec.attribute(name, *text);
    else if (const auto* number = std::get_if<float>(&contents))
      spec.attribute(name, *number);
    else
      spec.attribute(name, std::get<int>(contents));
  if (const auto& placement = layout.placement) {
    spec.x = placement->x, spec.y = placement->y;
    spec.full_width = placement->width, spec.full_height = placement->height;
  }
  return spec;
}

// All channels of the rows from `top` on, as many as `rows` has.
void interleave(std::span<const Image* const> images, int top, Image& rows) {
  int offset = 0;
  for (const Image* image : images) {
    for (int y = 0; y < rows.height; ++y)
      for (int x = 0; x < rows.width; ++x)
        std::copy_n(image->at(x, top + y), image->channels, rows.at(x, y) + offset);
    offset += image->channels;
  }
  assert(offset == rows.channels);
}

// Whole blocks of compression; else about kFloatsWrittenAtOnce, and no more than keeps all threads
// busy.
int rowsAtOnce(const OIIO::ImageSpec& spec, bool separateRows) {
  constexpr int kMost = 256;
  const auto floatsPerRow = int64_t(spec.width) * spec.nchannels;
  return int(
      std::clamp<int64_t>(kFloatsWrittenAtOnce / floatsPerRow, separateRows ? 1 : 16, kMost));
}

}  // namespace

class ExrRowsWriter::Output {
 public:
  Output(const fs::path& path, const ExrLayout& layout)
      : path_(path),
        file_(path),
        spec_(specOf(layout)),
        most_(rowsAtOnce(spec_, layout.separateRows)),
        out_(OIIO::ImageOutput::create("openexr")) {
    if (!out_) throwRun("{}: this build of OpenImageIO does not write OpenEXR", path.string());
    check(out_->open(file_.temporary().string(), spec_));
  }

  void write(std::span<const Image* const> images) {
    const int count = images.front()->height;
    for (int top = 0; top < count; top += most_) {
      Image rows(spec_.width, std::min(most_, count - top), spec_.nchannels);
      interleave(images, top, rows);
      const int y = spec_.y + written_;
      check(
          out_->write_scanlines(y, y + rows.height, 0, OIIO::TypeDesc::FLOAT, rows.texels.data()));
      written_ += rows.height;
    }
  }

  void commit(const std::function<void(Archive&)>& state) {
    assert(written_ == spec_.height);
    check(out_->close());
    if (state) appendExrState(file_.temporary(), path_, state);
    file_.commit();
  }

 private:
  void check(bool ok) const {
    if (ok) return;
    const std::string reason = out_->geterror();
    throwRun("{}: cannot be written: {}", path_.string(),
             reason.empty() ? std::strerror(errno) : reason);
  }

  fs::path path_;
  AtomicFile file_;
  OIIO::ImageSpec spec_;
  int most_, written_ = 0;  // rows
  std::unique_ptr<OIIO::ImageOutput> out_;
};

ExrRowsWriter::ExrRowsWriter(const fs::path& path, const ExrLayout& layout)
    : output_(std::make_unique<Output>(path, layout)) {}

ExrRowsWriter::~ExrRowsWriter() = default;

void ExrRowsWriter::write(std::span<const Image* const> images) { output_->write(images); }

void ExrRowsWriter::commit(const std::function<void(Archive&)>& state) { output_->commit(state); }

// The rows at once, also as halves; and of OpenEXR two rows a thread, with their compression.
double ExrRowsWriter::bufferBytes(int width, size_t channels) {
  const double row = double(sizeof(float)) * width * double(channels);
  const double atOnce = std::max(double(sizeof(float)) * double(kFloatsWrittenAtOnce), row);
  return 1.5 * atOnce + 2.0 * std::thread::hardware_concurrency() * 3 * row;
}

}  // namespace chromeball
