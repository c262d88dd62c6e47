// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/archive.h"
#include "base/byte_planes.h"
#include "base/checksum.h"
#include "base/error.h"
#include "base/parallel.h"
#include "image/io/exr_state.h"

namespace chromeball {
namespace {

namespace fs = std::filesystem;

class BlockWriter : public MemoryWriter {
 protected:
  void itemBytes(void* data, size_t count, size_t size) override {
    packPlanes(static_cast<const char*>(data), count, size, contents);
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

void appendExrState(const fs::path& file, const fs::path& path,
                    const std::function<void(Archive&)>& state) {
  StateWriter writer(file, path);
  state(writer);
  writer.end();
}

}  // namespace chromeball
