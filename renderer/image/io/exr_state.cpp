// SPDX-License-Identifier: Apache-2.0
#include "image/io/exr_state.h"

#include <blosc.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/archive.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/parallel.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

class BlockReader : public MemoryReader {
 public:
  using MemoryReader::MemoryReader;

 protected:
  void itemBytes(void* data, size_t count, size_t size) override {
    if (count * size == 0) return;
    check(rest().size() >= BLOSC_MIN_HEADER_LENGTH);
    size_t bytes = 0, packed = 0, ofBlock = 0;
    blosc_cbuffer_sizes(rest().data(), &bytes, &packed, &ofBlock);
    check(packed <= rest().size() && blosc_cbuffer_validate(rest().data(), packed, &bytes) == 0 &&
          bytes == count * size &&
          blosc_decompress_ctx(rest().data(), data, bytes, 1) == int(bytes));
    skip(packed);
  }
};

struct Layout {
  std::vector<char> head;
  std::vector<ExrStateBlock> table;
  std::vector<uint64_t> places;  // of the blocks
};

Layout readLayout(const SharedFile& file, uint64_t length) {
  ExrStateFooter footer;
  if (length >= sizeof(footer)) file.read(length - sizeof(footer), &footer, sizeof(footer));
  if (length < sizeof(footer) || footer.magic != ExrStateFooter::kMagic)
    throwInput("{}: is no checkpoint and no part of a render, or damaged", file.name());
  const auto check = [&](bool holds) {
    if (!holds) throwInput("{}: damaged: its checksum is wrong", file.name());
  };
  uint64_t left = length - sizeof(footer);  // bytes that are not accounted for
  const auto take = [&](uint64_t bytes) {
    check(bytes <= left);
    left -= bytes;
  };
  check(footer.blocks <= left / sizeof(ExrStateBlock));
  take(footer.blocks * sizeof(ExrStateBlock));
  take(footer.headLength);
  Layout layout;
  layout.head.resize(footer.headLength + footer.blocks * sizeof(ExrStateBlock));
  file.read(left, layout.head.data(), layout.head.size());
  check(checksum(layout.head) == footer.checksum);
  layout.table.resize(footer.blocks);
  std::copy(layout.head.begin() + ptrdiff_t(footer.headLength), layout.head.end(),
            reinterpret_cast<char*>(layout.table.data()));
  layout.head.resize(footer.headLength);
  uint64_t place = footer.imageLength;
  take(footer.imageLength);
  for (const ExrStateBlock& block : layout.table) {
    layout.places.push_back(place);
    place += block.length;
    take(block.length);
  }
  return layout;
}

class StateReader : public MemoryReader {
 public:
  StateReader(const SharedFile& file, const Layout& layout)
      : MemoryReader(layout.head, file.name()), file_(file), layout_(layout) {}

  void blocks(size_t count, const std::function<void(Archive&, size_t)>& block) override {
    check(count <= layout_.table.size() - next_);
    parallelFor(size_t(0), count, [&](size_t i) { readBlock(next_ + i, i, block); });
    next_ += count;
  }

 private:
  void readBlock(size_t index, size_t i, const std::function<void(Archive&, size_t)>& block) const {
    std::vector<char> bytes(layout_.table[index].length);
    file_.read(layout_.places[index], bytes.data(), bytes.size());
    if (checksum(bytes) != layout_.table[index].checksum)
      throwInput("{}: damaged: its checksum is wrong", file_.name());
    BlockReader reader(bytes, file_.name());
    block(reader, i);
    check(reader.left() == 0);
  }

  const SharedFile& file_;
  const Layout& layout_;
  size_t next_ = 0;  // block
};

// Items are numbers with few bytes that differ: the counts and weights of pixels, the low bytes of
// sums of few samples. Blosc sorts them by byte.
class BlockWriter : public MemoryWriter {
 protected:
  void itemBytes(void* data, size_t count, size_t size) override {
    const size_t bytes = count * size, begin = contents.size();
    if (bytes == 0) return;
    contents.resize(begin + bytes + BLOSC_MAX_OVERHEAD);
    const int packed = blosc_compress_ctx(1, BLOSC_SHUFFLE, size, bytes, data, &contents[begin],
                                          bytes + BLOSC_MAX_OVERHEAD, "lz4", 0, 1);
    if (packed <= 0) throw std::length_error("a block of a state has 2 GB");
    contents.resize(begin + size_t(packed));
  }
};

// Collects the head, and writes the blocks.
class StateWriter : public MemoryWriter {
 public:
  StateWriter(const fs::path& file, const fs::path& path)
      : path_(path), out_(file, std::ios::binary | std::ios::app) {
    footer_.imageLength = fs::file_size(file);
  }

  void blocks(size_t count, const std::function<void(Archive&, size_t)>& block) override {
    constexpr size_t kAtOnce = 32;
    for (size_t begin = 0; begin < count; begin += kAtOnce) {
      std::vector<BlockWriter> some(std::min(kAtOnce, count - begin));
      std::vector<uint64_t> sums(some.size());
      parallelFor(size_t(0), some.size(), [&](size_t i) {
        block(some[i], begin + i);
        sums[i] = checksum(some[i].contents);
      });
      for (size_t i = 0; i < some.size(); ++i) {
        table_.push_back({some[i].contents.size(), sums[i]});
        write(some[i].contents);
      }
    }
  }

  void end() {
    footer_.blocks = table_.size();
    footer_.headLength = contents.size();
    const auto* table = reinterpret_cast<const char*>(table_.data());
    contents.insert(contents.end(), table, table + table_.size() * sizeof(ExrStateBlock));
    footer_.checksum = checksum(contents);
    write(contents);
    write({reinterpret_cast<const char*>(&footer_), sizeof(footer_)});
    out_.close();
    check();
  }

 private:
  void write(std::span<const char> bytes) {
    out_.write(bytes.data(), std::streamsize(bytes.size()));
    check();
  }
  void check() const {
    if (!out_) throwRun("{}: cannot be written: {}", path_.string(), std::strerror(errno));
  }

  fs::path path_;
  std::ofstream out_;
  std::vector<ExrStateBlock> table_;
  ExrStateFooter footer_;
};

}  // namespace

void readExrState(const fs::path& path, const std::function<void(Archive&)>& read) {
  const SharedFile file(path);
  const Layout layout = readLayout(file, fs::file_size(path));
  StateReader reader(file, layout);
  read(reader);
}

void appendExrState(const fs::path& file, const fs::path& path,
                    const std::function<void(Archive&)>& state) {
  StateWriter writer(file, path);
  state(writer);
  writer.end();
}

}  // namespace chromeball
