// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_rows.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <thread>

#include "base/error.h"
#include "base/file.h"
#include "image/io/exr_metadata.h"
#include "image/io/exr_state.h"
#include "image/io/image_format.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kFloatsWrittenAtOnce = int64_t(1) << 24;

// Remembers that a write failed: OpenEXR ignores what its destructor could not write.
class ExrStream : public Imf::OStream {
 public:
  explicit ExrStream(const fs::path& path) : OStream(path.c_str()), out_(path, std::ios::binary) {
    check();
  }

  void write(const char bytes[], int count) override {
    out_.write(bytes, count);
    check();
  }
  uint64_t tellp() override { return uint64_t(out_.tellp()); }
  void seekp(uint64_t at) override {
    out_.seekp(std::streamoff(at));
    check();
  }
  void close() {
    if (out_) out_.close();
    check();
  }

 private:
  void check() {
    if (!out_ && reason_ == 0) reason_ = errno;
    if (!out_) throw std::runtime_error(std::strerror(reason_));
  }

  std::ofstream out_;
  int reason_ = 0;
};

std::string localTime() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  char text[32];
  std::strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", localtime_r(&now, &parts));
  return text;
}

Imf::Header headerOf(const ExrLayout& layout) {
  const Placement whole{0, 0, layout.width, layout.height};
  const Placement& p = layout.placement ? *layout.placement : whole;
  using Imath::V2i;
  Imf::Header header(
      Imath::Box2i(V2i(0, 0), V2i(p.width - 1, p.height - 1)),
      Imath::Box2i(V2i(p.x, p.y), V2i(p.x + layout.width - 1, p.y + layout.height - 1)));
  header.compression() = layout.separateRows ? Imf::ZIPS_COMPRESSION : Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 4;
  setMetadata(layout.metadata, header);
  header.insert(kCaptureDate, Imf::StringAttribute(localTime()));
  for (const std::string& channel : layout.channels)
    header.channels().insert(channel, Imf::Channel(layout.halves ? Imf::HALF : Imf::FLOAT));
  return header;
}

// All channels of the rows from `top` on, as many as `rows` has.
void interleave(std::span<const Image* const> images, int top, Image& rows) {
  int offset = 0;
  for (const Image* image : images) {
    for (size_t i = 0; i < rows.pixels(); ++i)
      std::copy_n(image->at(image->pixel(0, top) + i), image->channels, rows.at(i) + offset);
    offset += image->channels;
  }
  assert(offset == rows.channels);
}

// The number of rows to write at once: whole blocks of compression, about kFloatsWrittenAtOnce, and
// no more than keep all threads busy.
int rowsAtOnce(const ExrLayout& layout) {
  constexpr int kMost = 256;
  const auto floatsPerRow = int64_t(layout.width) * int64_t(layout.channels.size());
  return int(std::clamp<int64_t>(kFloatsWrittenAtOnce / floatsPerRow, layout.separateRows ? 1 : 16,
                                 kMost));
}

std::vector<std::string> channelsOf(const OutputImage& output) {
  std::vector<std::string> names;
  for (const Layer& layer : output.layers) {
    if (layer.channels.empty()) names.push_back(layer.name);
    for (const char letter : layer.channels)
      names.push_back(layer.name.empty() ? std::string(1, letter) : layer.name + '.' + letter);
  }
  return names;
}

const fs::path& checkedExr(const fs::path& path) {
  if (imageFormat(path) != ImageFormat::Exr) throwUnreadable(path, "it is not an EXR file");
  return path;
}

}  // namespace

class ExrRowsWriter::Output {
 public:
  Output(const fs::path& path, const ExrLayout& layout)
      : path_(path), file_(path), layout_(layout), most_(rowsAtOnce(layout)) {
    useExrThreads();
    guarded([&] {
      stream_ = std::make_unique<ExrStream>(file_.temporary());
      out_ = std::make_unique<Imf::OutputFile>(*stream_, headerOf(layout));
    });
  }

  void write(std::span<const Image* const> images) {
    const int count = images.front()->height;
    for (int top = 0; top < count; top += most_) {
      Image rows(layout_.width, std::min(most_, count - top), int(layout_.channels.size()));
      interleave(images, top, rows);
      guarded([&] { writeRows(rows); });
    }
  }

  void commit(const std::function<void(Archive&)>& state) {
    assert(written_ == layout_.height);
    guarded([&] {
      out_.reset();
      stream_->close();
    });
    if (state) appendExrState(file_.temporary(), path_, state);
    file_.commit();
  }

  uint64_t clipped() const { return clipped_; }

 private:
  std::vector<half> clippedHalves(const std::vector<float>& numbers) {
    constexpr float kLargest = 65504;
    std::vector<half> halves(numbers.size());
    for (size_t i = 0; i < numbers.size(); ++i) {
      const bool isBeyond = std::fabs(numbers[i]) > kLargest && std::isfinite(numbers[i]);
      clipped_ += isBeyond;
      halves[i] = isBeyond ? std::copysign(kLargest, numbers[i]) : numbers[i];
    }
    return halves;
  }

  void writeRows(Image& rows) {
    const size_t channels = layout_.channels.size();
    std::vector<half> halves;
    if (layout_.halves) halves = clippedHalves(rows.texels);
    const size_t number = layout_.halves ? sizeof(half) : sizeof(float);
    char* texels = layout_.halves ? reinterpret_cast<char*>(halves.data())
                                  : reinterpret_cast<char*>(rows.texels.data());
    const Imath::Box2i window = out_->header().dataWindow();
    // OpenEXR addresses the texel (x, y) of the window by base + x * stride + y * row.
    const size_t stride = channels * number, row = stride * size_t(layout_.width);
    const ptrdiff_t offset =
        ptrdiff_t(row) * (window.min.y + written_) + ptrdiff_t(stride) * window.min.x;
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < channels; ++c)
      buffer.insert(layout_.channels[c], Imf::Slice(layout_.halves ? Imf::HALF : Imf::FLOAT,
                                                    texels + c * number - offset, stride, row));
    out_->setFrameBuffer(buffer);
    out_->writePixels(rows.height);
    written_ += rows.height;
  }

  template <class Call>
  void guarded(const Call& call) const {
    try {
      call();
    } catch (const std::exception& error) {
      throwRun("{}: cannot be written: {}", path_.string(), error.what());
    }
  }

  fs::path path_;
  AtomicFile file_;
  ExrLayout layout_;
  int most_, written_ = 0;  // rows
  uint64_t clipped_ = 0;    // numbers
  std::unique_ptr<ExrStream> stream_;
  std::unique_ptr<Imf::OutputFile> out_;
};

ExrRowsWriter::ExrRowsWriter(const fs::path& path, const ExrLayout& layout)
    : output_(std::make_unique<Output>(path, layout)) {}

ExrRowsWriter::~ExrRowsWriter() = default;

void ExrRowsWriter::write(std::span<const Image* const> images) { output_->write(images); }

uint64_t ExrRowsWriter::clipped() const { return output_->clipped(); }

void ExrRowsWriter::commit(const std::function<void(Archive&)>& state) { output_->commit(state); }

// The rows written at once, also as halves; and OpenEXR's two rows per thread, with their
// compression.
double ExrRowsWriter::bufferBytes(int width, size_t channels) {
  const double row = double(sizeof(float)) * width * double(channels);
  const double atOnce = std::max(double(sizeof(float)) * double(kFloatsWrittenAtOnce), row);
  return 1.5 * atOnce + 2.0 * std::thread::hardware_concurrency() * 3 * row;
}

void writeExr(const std::filesystem::path& path, const OutputImage& output) {
  const Image& first = output.layers.front().image;
  ExrRowsWriter writer(path, {.width = first.width,
                              .height = first.height,
                              .channels = channelsOf(output),
                              .metadata = output.metadata,
                              .placement = output.placement});
  std::vector<const Image*> images;
  for (const Layer& layer : output.layers) images.push_back(&layer.image);
  writer.write(images);
  writer.commit(output.state);
}

ExrRowsReader::ExrRowsReader(const fs::path& path, uint64_t maxNumbers)
    : ExrInput(checkedExr(path), maxNumbers) {
  if (isTiled()) throwUnreadable(path, "deep, volume and tiled images are not supported here");
  if (numbers() != Numbers::Half && numbers() != Numbers::Float)
    throwUnreadable(path, "its channels should be all of 32 or all of 16 bits, not integers");
}

Image ExrRowsReader::read(int top, int count) {
  Image rows(width(), count, int(channels().size()));
  ExrInput::read(top, count, rows.texels.data());
  return rows;
}

// OpenEXR's buffers: two blocks per thread, with their compression.
double ExrRowsReader::bufferBytes() const {
  const double row = double(sizeof(float)) * width() * double(channels().size());
  return row * 2.0 * std::thread::hardware_concurrency() * 3 * rowsOfBlock();
}

}  // namespace chromeball
