// SPDX-License-Identifier: Apache-2.0
// The state behind the image of an .exr, which this program reads again.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numeric>

#include "base/error.h"
#include "base/hash.h"
#include "image/io/exr_rows.h"
#include "image/io/exr_state.h"
#include "image/io/read_image.h"
#include "run_command.h"

namespace chromeball::exr_state_test {
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
  std::vector<float> pixels = numbers(5000);

  static std::vector<float> numbers(size_t count) {
    std::vector<float> all(count);
    std::iota(all.begin(), all.end(), 0.5f);
    return all;
  }
  void archive(Archive& a) {
    a(number), a(flag), a(text), a(list), a(items);
    constexpr size_t kOfBlock = 300;
    a.blocks((pixels.size() + kOfBlock - 1) / kOfBlock, [&](Archive& block, size_t i) {
      const size_t first = i * kOfBlock;
      block.items(std::span(pixels).subspan(first, std::min(kOfBlock, pixels.size() - first)));
    });
    a(bytes);
  }
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
  for (const size_t bytes : {0u, 1u, 4096u, 100'000u})
    for (size_t more = 0; more < 12; ++more) {
      Contents written{.number = bytes};
      written.bytes.assign(bytes + more, 'x');
      writeExr(path, imageWith(written));
      Contents read{.list = {}, .items = {}};
      std::ranges::fill(read.pixels, 0);
      readExrState(path, [&](Archive& a) { read.archive(a); });
      EXPECT_EQ(read.number, bytes);
      EXPECT_EQ(read.list, written.list);
      ASSERT_EQ(read.items.size(), 3u);
      EXPECT_EQ(read.items[2].numbers, written.items[2].numbers);
      EXPECT_EQ(read.bytes, written.bytes);
      EXPECT_EQ(read.pixels, written.pixels);
    }
  const ImageFile image = readImageFile(path);  // other readers see the image
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
  ExrStateFooter footer;
  good.copy(reinterpret_cast<char*>(&footer), sizeof(footer), good.size() - sizeof(footer));
  EXPECT_EQ(footer.blocks, 17u);
  for (size_t at = footer.imageLength; at < good.size(); at += 97) {
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

// A file of another length than its footer says, of other blocks, or with a footer of its own.
TEST(ExrState, FindsDamagedFooters) {
  const TemporaryFolder folder;
  const std::string path = folder / "state.exr";
  Contents contents;
  writeExr(path, imageWith(contents));
  const std::string good = fileContents(path);
  for (size_t back = 1; back <= sizeof(ExrStateFooter) + 18 * sizeof(ExrStateBlock); ++back)
    for (const char change : {'\x01', '\x80', '\xff'}) {
      std::string bad = good;
      bad[bad.size() - back] ^= change;
      std::ofstream(path, std::ios::binary) << bad;
      Contents read;
      EXPECT_THROW(readExrState(path, [&](Archive& a) { read.archive(a); }), InputError) << back;
    }
}

TEST(ExrState, MustHaveTheBlocksThatAreRead) {
  const TemporaryFolder folder;
  const std::string path = folder / "state.exr";
  Contents contents;
  writeExr(path, imageWith(contents));
  for (const size_t pixels : {300u, 4999u, 5001u, 6000u}) {
    Contents read;
    read.pixels.resize(pixels);
    if (pixels == 300)  // the others are left
      EXPECT_NO_THROW(readExrState(path, [&](Archive& a) { read.archive(a); }));
    else
      EXPECT_THROW(readExrState(path, [&](Archive& a) { read.archive(a); }), InputError);
  }
}

TEST(Checksum, ChangesWithEveryByte) {
  std::vector<char> bytes(100);
  for (size_t i = 0; i < bytes.size(); ++i) bytes[i] = char(hash(i));
  for (size_t length = 0; length <= bytes.size(); ++length) {
    std::vector<char> some(bytes.begin(), bytes.begin() + ptrdiff_t(length));
    const uint64_t sum = checksum(some);
    for (char& byte : some)
      for (const char change : {'\x01', '\x80'}) {
        byte ^= change;
        EXPECT_NE(checksum(some), sum);
        byte ^= change;
      }
    some.push_back(0);
    EXPECT_NE(checksum(some), sum);
  }
}

// Lists of items of any size come back, and items that differ in few bytes take less room.
TEST(ExrState, PacksItems) {
  const TemporaryFolder folder;
  const std::string path = folder / "state.exr";
  OutputImage output{
      .layers = {{"", "RGB", Image(1, 1, 3)}}, .metadata = {}, .placement = {}, .state = {}};
  const auto test = [&]<size_t kSize>(std::integral_constant<size_t, kSize>) {
    using Sized = std::array<uint8_t, kSize>;
    for (const size_t count : {0u, 1u, 2u, 255u, 256u, 257u, 1000u, 70000u}) {
      std::vector<Sized> items(count), read(count);
      for (size_t i = 0; i < count; ++i)  // every third byte is the same in all items
        for (size_t b = 0; b < kSize; ++b)
          items[i][b] = uint8_t(b % 3 == 0 ? b : hash(i * kSize + b));
      const auto archive = [](std::vector<Sized>& list) {
        return [&list](Archive& a) {
          a.blocks(1, [&](Archive& block, size_t) {
            uint32_t mark = 7;
            block.items(std::span(list)), block(mark), block.items(std::span(list));
            block.check(mark == 7);
          });
        };
      };
      output.state = archive(items);
      writeExr(path, output);
      readExrState(path, archive(read));
      EXPECT_EQ(read, items) << kSize << " x " << count;
      if (count == 70000 && kSize == 104) {
        EXPECT_LT(double(std::filesystem::file_size(path)), 0.7 * 2 * double(count * kSize));
      }
    }
  };
  test(std::integral_constant<size_t, 1>());
  test(std::integral_constant<size_t, 8>());
  test(std::integral_constant<size_t, 13>());
  test(std::integral_constant<size_t, 104>());
  test(std::integral_constant<size_t, 300>());
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
}  // namespace chromeball::exr_state_test
