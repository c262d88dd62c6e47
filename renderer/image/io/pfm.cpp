// SPDX-License-Identifier: Apache-2.0
#include "image/io/pfm.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "image/io/image_format.h"
#include "image/size_limits.h"

namespace chromeball {

static_assert(std::endian::native == std::endian::little);

namespace {

constexpr std::string_view kSpace = " \t\r\n";

// The next word of the header. Moves `position` to the white space after it.
std::string_view nextWord(std::string_view text, size_t& position) {
  const size_t begin = std::min(text.find_first_not_of(kSpace, position), text.size());
  position = std::min(text.find_first_of(kSpace, begin), text.size());
  return text.substr(begin, position - begin);
}

template <class Number>
Number parse(const std::filesystem::path& path, std::string_view word) {
  Number number{};
  if (!toNumber(word, number))
    throwInput("{}: the PFM header should be: PF, width, height, scale", path.string());
  return number;
}

}  // namespace

Image readPfm(const std::filesystem::path& path, Messages& messages) {
  const std::vector<uint8_t> bytes = readFile(path);
  const std::string_view text = textOf(bytes).substr(0, 256);
  size_t position = 0;
  const std::string_view magic = nextWord(text, position);
  if (magic != "PF" && magic != "Pf") throwInput("{}: not a PFM file", path.string());
  const int width = parse<int>(path, nextWord(text, position));
  const int height = parse<int>(path, nextWord(text, position));
  const double scale = parse<double>(path, nextWord(text, position));
  const double factor = std::fabs(scale);
  if (!(factor > 1e-20 && factor < 1e20))
    throwInput("{}: the scale of a PFM, {}, should be a number below or above 0, 1e-20 to 1e20",
               path.string(), scale);
  if (factor != 1)
    addNote(messages, "{}: its texels are multiplied by the scale of its header, {:g}",
            path.string(), factor);
  const bool littleEndian = scale < 0;
  size_t begin = position + 1;  // one white space

  const int channels = magic == "PF" ? 3 : 1;
  checkImageSize(path, width, height, channels);
  checkImageMemory(path, width, height, channels);
  const size_t rowBytes = size_t(width) * channels * sizeof(float);
  // Or all white space up to the line's end; only the length of the file can tell.
  if (const size_t end = text.find('\n', position);
      end < text.find_first_not_of(kSpace, position) && bytes.size() == end + 1 + rowBytes * height)
    begin = end + 1;
  if (bytes.size() < begin || bytes.size() - begin < rowBytes * height)
    throwInput("{}: {} x {} texels need {} bytes, but the file has {}", path.string(), width,
               height, begin + rowBytes * height, bytes.size());

  Image image(width, height, channels);
  for (int y = 0; y < height; ++y)
    std::memcpy(image.at(0, height - 1 - y), bytes.data() + begin + y * rowBytes, rowBytes);
  if (!littleEndian)
    for (float& f : image.texels)
      f = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<uint32_t>(f)));
  if (factor != 1)
    for (float& f : image.texels) f = float(f * factor);
  return image;
}

void writePfm(const std::filesystem::path& path, const Image& image) {
  const int channels = image.channels >= 3 ? 3 : 1;
  const std::string header =
      fmt::format("{}\n{} {}\n-1.0\n", channels == 3 ? "PF" : "Pf", image.width, image.height);
  std::vector<uint8_t> bytes(header.begin(), header.end());
  const size_t texelBytes = channels * sizeof(float);
  bytes.resize(header.size() + texelBytes * image.width * image.height);
  uint8_t* out = bytes.data() + header.size();
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x, out += texelBytes)
      std::memcpy(out, image.at(x, y), texelBytes);
  writeFile(path, bytes);
}

}  // namespace chromeball
