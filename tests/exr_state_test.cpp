// SPDX-License-Identifier: Apache-2.0
// The second part of an .exr, which holds what this program reads again.
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "image/io/write_exr.h"
#include "memory_archive.h"
#include "run_command.h"

namespace chromeball {
namespace {

struct Item {
  std::vector<uint16_t> numbers;
  void archive(Archive& a) { a(numbers); }
};

struct Contents {
  uint64_t number = 7;
  bool flag = true;
  std::string text = "text";
  std::vector<double> list = {1, 2, 3};
  std::vector<Item> items = {{{1, 2}}, {{}}, {{3}}};
  std::vector<char> bytes;

  void archive(Archive& a) { a(number), a(flag), a(text), a(list), a(items), a(bytes); }
};

OutputImage imageWith(Contents& contents) {
  Image color(5, 3, 3);
  color.setRgb(2, 1, {1, 2, 3});
  OutputImage output{.layers = {{"", "RGB", color}}, .metadata = {}, .placement = {}, .state = {}};
  output.state = [&](Archive& a) { contents.archive(a); };
  return output;
}

TEST(ExrState, RoundTripsAnyNumberOfBytes) {
  const TemporaryFolder folder;
  const std::string path = folder / "state.exr";
  constexpr size_t kRow = 4096 * 4;  // bytes
  for (const size_t bytes : {size_t(0), size_t(1), kRow - 90, kRow - 70, kRow, 3 * kRow + 5})
    for (size_t more = 0; more < 12; ++more) {
      Contents written{.number = bytes};
      written.bytes.assign(bytes + more, 'x');
      writeExr(path, imageWith(written));
      Contents read{.list = {}, .items = {}};
      readExrState(path, [&](Archive& a) { read.archive(a); });
      EXPECT_EQ(read.number, bytes);
      EXPECT_EQ(read.list, written.list);
      ASSERT_EQ(read.items.size(), 3u);
      EXPECT_EQ(read.items[2].numbers, written.items[2].numbers);
      EXPECT_EQ(read.bytes, written.bytes);
    }
  const ImageFile image = readImageFile(path);  // other readers see the first part
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(findColor(image)->rgb(2, 1), Rgb(1, 2, 3));
}

TEST(ExrState, FindsDamage) {
  const TemporaryFolder folder;
  const std::string path = folder / "state.exr", damaged = folder / "damaged.exr";
  Contents contents;
  contents.bytes.assign(40'000, 'x');
  writeExr(path, imageWith(contents));
  const std::string good = fileContents(path);
  const auto expectRefused = [&](const std::string& bytes, size_t at) {
    std::ofstream(damaged, std::ios::binary) << bytes;
    Contents read;
    EXPECT_THROW(readExrState(damaged, [&](Archive& a) { read.archive(a); }), InputError) << at;
  };
  const size_t first = good.find("xxxxxxxx");
  ASSERT_NE(first, std::string::npos);
  for (size_t at = first; at < good.size(); at += 977) {
    if (good[at] != 'x') continue;  // the rows' own headers, and padding
    std::string bad = good;
    bad[at] ^= 1;
    expectRefused(bad, at);
  }
  for (size_t length = 0; length < good.size(); length += 1013)
    expectRefused(good.substr(0, length), length);
}

TEST(ExrState, IsOfThisProgram) {
  const TemporaryFolder folder;
  const std::string path = folder / "plain.exr";
  writeImage(path, Image(2, 2, 3));
  EXPECT_THROW(readExrState(path, [](Archive&) {}), InputError);
  EXPECT_THROW(readExrState(folder / "none.exr", [](Archive&) {}), InputError);
}

// Every byte of what is summed counts: numbers, flags, texts and lists.
TEST(Archive, SumsFindAnyDamage) {
  Contents contents;
  contents.bytes.assign(20, 'x');
  const auto archive = [](Archive& a, Contents& c) {
    a.startSum();
    c.archive(a);
    a.endSum();
  };
  MemoryWriter writer;
  archive(writer, contents);
  for (size_t at = 0; at < writer.contents.size(); ++at) {
    std::vector<char> damaged = writer.contents;
    damaged[at] ^= 1;
    MemoryReader reader(damaged);
    Contents read;
    EXPECT_THROW(archive(reader, read), InputError) << at;
  }
  MemoryReader reader(writer.contents);
  Contents read;
  archive(reader, read);
  EXPECT_EQ(read.bytes, contents.bytes);
}

// A file may claim to hold more than it does.
TEST(ExrState, DoesNotAllocateWhatIsNotThere) {
  const TemporaryFolder folder;
  const std::string path = folder / "state.exr";
  OutputImage output{
      .layers = {{"", "RGB", Image(1, 1, 3)}}, .metadata = {}, .placement = {}, .state = {}};
  output.state = [](Archive& a) {
    uint64_t count = uint64_t(1) << 60;
    a(count);
  };
  writeExr(path, output);
  std::vector<double> list;
  EXPECT_THROW(readExrState(path, [&](Archive& a) { a(list); }), InputError);
  std::vector<Item> items;
  EXPECT_THROW(readExrState(path, [&](Archive& a) { a(items); }), InputError);
}

}  // namespace
}  // namespace chromeball
