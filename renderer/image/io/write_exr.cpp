// SPDX-License-Identifier: Apache-2.0
#include "image/io/write_exr.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "image/io/exr_header.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

constexpr size_t kWordsPerRow = 4096;
constexpr const char* kStateName = "state";

// Of the bytes so far, in words.
class Checksum {
 public:
  void add(std::span<const uint32_t> words) {
    for (const uint32_t word : words) sum_ = hash(sum_ ^ word);
  }
  uint64_t value() const { return sum_; }

 private:
  uint64_t sum_ = 0;
};

// Counts the bytes that would be written.
class CountingArchive : public Archive {
 public:
  bool reads() const override { return false; }
  uint64_t count = 0;

 protected:
  void bytes(void*, size_t added) override { count += added; }
};

// Collects bytes into rows of words.
class WritingArchive : public Archive {
 public:
  using WriteRow = std::function<void(std::span<const uint32_t>)>;
  explicit WritingArchive(WriteRow writeRow) : writeRow_(std::move(writeRow)) {}

  bool reads() const override { return false; }
  // Fills the last row, which ends with the checksum.
  void end() {
    if (kBytes - used_ < sizeof(uint64_t)) flush();
    checksum_.add(std::span(row_).first(kWordsPerRow - 2));
    const uint64_t sum = checksum_.value();
    std::memcpy(&row_[kWordsPerRow - 2], &sum, sizeof(sum));
    writeRow_(row_);
  }

 protected:
  void bytes(void* data, size_t count) override {
    const char* from = static_cast<const char*>(data);
    while (count > 0) {
      const size_t some = std::min(count, kBytes - used_);
      std::memcpy(reinterpret_cast<char*>(row_.data()) + used_, from, some);
      used_ += some, from += some, count -= some;
      if (used_ == kBytes) flush();
    }
  }

 private:
  static constexpr size_t kBytes = kWordsPerRow * sizeof(uint32_t);

  void flush() {
    checksum_.add(row_);
    writeRow_(row_);
    std::ranges::fill(row_, 0);
    used_ = 0;
  }

  WriteRow writeRow_;
  std::vector<uint32_t> row_ = std::vector<uint32_t>(kWordsPerRow);
  size_t used_ = 0;
  Checksum checksum_;
};

uint64_t rowsFor(uint64_t bytes) {
  constexpr uint64_t kRow = kWordsPerRow * sizeof(uint32_t);
  return (bytes + sizeof(uint64_t) + kRow - 1) / kRow;
}

class ReadingArchive : public Archive {
 public:
  // `readRow` fills a row.
  using ReadRow = std::function<void(int row, std::span<uint32_t>)>;
  ReadingArchive(std::string name, int rows, ReadRow readRow)
      : name_(std::move(name)), rows_(rows), readRow_(std::move(readRow)) {}

  bool reads() const override { return true; }
  std::string name() const override { return name_; }
  uint64_t left() const override { return uint64_t(rows_ - next_) * kBytes + kBytes - used_; }
  // Reads the rest, which ends with the checksum.
  void end() {
    while (next_ < rows_) fill();
    Checksum sum = before_;
    sum.add(std::span(row_).first(kWordsPerRow - 2));
    uint64_t stored;
    std::memcpy(&stored, &row_[kWordsPerRow - 2], sizeof(stored));
    if (stored != sum.value()) throwInput("{}: damaged: its checksum is wrong", name_);
  }

 protected:
  void bytes(void* data, size_t count) override {
    char* to = static_cast<char*>(data);
    while (count > 0) {
      if (used_ == kBytes) fill();
      const size_t some = std::min(count, kBytes - used_);
      std::memcpy(to, reinterpret_cast<const char*>(row_.data()) + used_, some);
      used_ += some, to += some, count -= some;
    }
  }

 private:
  static constexpr size_t kBytes = kWordsPerRow * sizeof(uint32_t);

  void fill() {
    check(next_ < rows_);
    if (next_ > 0) before_.add(row_);
    readRow_(next_++, row_);
    used_ = 0;
  }

  std::string name_;
  int rows_, next_ = 0;
  ReadRow readRow_;
  std::vector<uint32_t> row_ = std::vector<uint32_t>(kWordsPerRow);
  size_t used_ = kBytes;
  Checksum before_;  // of the rows before this one
};

std::vector<std::string> channelNames(const OutputImage& output) {
  std::vector<std::string> names;
  for (const Layer& layer : output.layers) {
    if (layer.channels.empty()) names.push_back(layer.name);
    for (const char letter : layer.channels)
      names.push_back(layer.name.empty() ? std::string(1, letter) : layer.name + '.' + letter);
  }
  return names;
}

OIIO::ImageSpec specOf(const OutputImage& output) {
  const Image& color = output.layers.front().image;
  const std::vector<std::string> names = channelNames(output);
  OIIO::ImageSpec spec(color.width, color.height, int(names.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = names;
  if (const auto& placement = output.placement) {
    spec.x = placement->x, spec.y = placement->y;
    spec.full_width = placement->width, spec.full_height = placement->height;
  }
  spec.attribute("compression", "zip");
  for (const auto& [name, contents] : output.metadata)
    if (const auto* matrix = std::get_if<Matrix44>(&contents))
      spec.attribute(name, OIIO::TypeMatrix, matrix->data());
    else if (const auto* text = std::get_if<std::string>(&contents))
      spec.attribute(name, *text);
    else if (const auto* number = std::get_if<float>(&contents))
      spec.attribute(name, *number);
    else
      spec.attribute(name, std::get<int>(contents));
  return spec;
}

// The parts of a file have the same display window.
OIIO::ImageSpec stateSpec(const OIIO::ImageSpec& image,
                          const std::function<void(Archive&)>& state) {
  CountingArchive counter;
  state(counter);
  OIIO::ImageSpec spec(int(kWordsPerRow), int(rowsFor(counter.count)), 1, OIIO::TypeDesc::UINT32);
  spec.channelnames = {kStateName};
  spec.full_width = image.full_width, spec.full_height = image.full_height;
  spec.attribute("compression", "none");
  spec.attribute("oiio:subimagename", kStateName);
  return spec;
}

Image interleaved(const OutputImage& output, int channels) {
  const Image& color = output.layers.front().image;
  Image all(color.width, color.height, channels);
  int offset = 0;
  for (const Layer& layer : output.layers) {
    for (int y = 0; y < all.height; ++y)
      for (int x = 0; x < all.width; ++x)
        std::copy_n(layer.image.at(x, y), layer.image.channels, all.at(x, y) + offset);
    offset += layer.image.channels;
  }
  return all;
}

}  // namespace

void writeExr(const fs::path& path, const OutputImage& output) {
  AtomicFile file(path);
  const auto out = OIIO::ImageOutput::create("openexr");
  if (!out) throwRun("{}: this build of OpenImageIO does not write OpenEXR", path.string());
  const auto check = [&](bool ok) {
    if (ok) return;
    const std::string reason = out->geterror();
    throwRun("{}: cannot be written: {}", path.string(),
             reason.empty() ? std::strerror(errno) : reason);
  };
  std::vector<OIIO::ImageSpec> specs = {specOf(output)};
  if (output.state) {
    specs[0].attribute("oiio:subimagename", "image");
    specs.push_back(stateSpec(specs[0], output.state));
  }
  check(out->open(file.temporary().string(), int(specs.size()), specs.data()));
  check(out->write_image(OIIO::TypeDesc::FLOAT,
                         interleaved(output, specs[0].nchannels).texels.data()));
  if (output.state) {
    check(out->open(file.temporary().string(), specs[1], OIIO::ImageOutput::AppendSubimage));
    int row = 0;
    WritingArchive archive([&](std::span<const uint32_t> words) {
      check(out->write_scanline(row++, 0, OIIO::TypeDesc::UINT32, words.data()));
    });
    output.state(archive);
    archive.end();
  }
  check(out->close());
  file.commit();
}

void readExrState(const fs::path& path, const std::function<void(Archive&)>& read,
                  Checked checked) {
  checkReadable(path);
  checkExrHeaders(path);
  const auto in = OIIO::ImageInput::open(path.string());
  if (!in) throwInput("{}: not an image: {}", path.string(), OIIO::geterror());
  if (!in->seek_subimage(1, 0) || in->spec().channelnames != std::vector<std::string>{kStateName} ||
      in->spec().width != int(kWordsPerRow) || in->spec().format != OIIO::TypeDesc::UINT32) {
    in->geterror();
    throwInput("{}: is no checkpoint and no part of a render", path.string());
  }
  // The part is not compressed.
  if (uint64_t(in->spec().height) * kWordsPerRow * sizeof(uint32_t) > fs::file_size(path))
    throwInput("{}: damaged: it is shorter than its header says", path.string());
  ReadingArchive archive(path.string(), in->spec().height, [&](int row, std::span<uint32_t> words) {
    if (!in->read_scanline(in->spec().y + row, 0, OIIO::TypeDesc::UINT32, words.data()))
      throwInput("{}: damaged: {}", path.string(), in->geterror());
  });
  read(archive);
  if (checked == Checked::Yes) archive.end();
}

}  // namespace chromeball
