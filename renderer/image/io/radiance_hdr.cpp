// SPDX-License-Identifier: Apache-2.0
#include "image/io/radiance_hdr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/file.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

using Rgbe = std::array<uint8_t, 4>;

// The widths that the newer run-length encoding allows.
constexpr int kMinRunWidth = 8, kMaxRunWidth = 32767;

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path), bytes_(readFile(path)) {}

  Image read() {
    readHeader();
    checkFileLength();
    Image image(width_, height_, 3);
    std::vector<Rgbe> row(width_);
    for (int y = 0; y < height_; ++y) {
      readRow(row);
      for (int x = 0; x < width_; ++x)
        image.setRgb(rightToLeft_ ? width_ - 1 - x : x, bottomUp_ ? height_ - 1 - y : y,
                     decode(row[x]));
    }
    return image;
  }

  HdrComments takeComments() { return std::move(comments_); }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throwInput("{}: {}", path_.string(), what);
  }

  std::string_view line() {
    const std::string_view rest(reinterpret_cast<const char*>(bytes_.data()) + position_,
                                bytes_.size() - position_);
    const size_t end = rest.find('\n');
    if (end > 4096) fail("the Radiance header does not end");  // npos too
    position_ += end + 1;
    return rest.substr(0, end);
  }

  void readHeader() {
    if (!line().starts_with("#?")) fail("not a Radiance HDR file");
    double exposure = 1;
    for (std::string_view text = line(); !text.empty() && text != "\r"; text = line()) {
      if (text.starts_with("FORMAT=") && text.find("32-bit_rle_rgbe") == std::string_view::npos)
        fail("unsupported FORMAT; it must be 32-bit_rle_rgbe");
      if (text.starts_with("# ")) addComment(text.substr(2));
      if (text.starts_with("EXPOSURE=")) exposure *= std::atof(std::string(text.substr(9)).c_str());
    }
    if (!(exposure > 1e-20 && exposure < 1e20)) fail("EXPOSURE must be a positive number");
    scale_ = 1 / exposure;

    const std::string resolution(line());
    char ySign = 0, xSign = 0;
    if (std::sscanf(resolution.c_str(), "%cY %d %cX %d", &ySign, &height_, &xSign, &width_) != 4)
      fail("the resolution line should read: -Y height +X width");
    bottomUp_ = ySign == '+';
    rightToLeft_ = xSign == '-';
    checkImageSize(path_, width_, height_, 3);
  }

  void addComment(std::string_view text) {
    const size_t equals = text.find('=');
    if (equals == std::string_view::npos) return;
    const std::string_view value = text.substr(equals + 1);
    comments_[std::string(text.substr(0, equals))] = value.substr(0, value.find('\r'));
  }

  bool atRunLengthRow() const {
    return width_ >= kMinRunWidth && width_ <= kMaxRunWidth && bytes_.size() - position_ >= 4 &&
           bytes_[position_] == 2 && bytes_[position_ + 1] == 2 &&
           bytes_[position_ + 2] * 256 + bytes_[position_ + 3] == width_;
  }

  // Throws if the file is too short for the image that its header claims, before its texels are
  // allocated. A run takes two bytes for at most 127 texels. The older encoding has no such bound;
  // 1000 texels per texel of the file is an estimate.
  void checkFileLength() const {
    const uint64_t left = bytes_.size() - position_;
    const uint64_t minimum = atRunLengthRow()
                                 ? uint64_t(height_) * (4 + 8 * uint64_t((width_ + 126) / 127))
                                 : uint64_t(width_) * height_ * 4 / 1000;
    if (left < minimum) fail(fmt::format("too short for {} x {} texels", width_, height_));
  }

  uint8_t byte() {
    if (position_ >= bytes_.size()) fail("the file ends before its last texel");
    return bytes_[position_++];
  }

  void readRow(std::vector<Rgbe>& row) {
    if (!atRunLengthRow()) return readOldRow(row);
    position_ += 4;
    for (int channel = 0; channel < 4; ++channel)
      for (int x = 0; x < width_;) {
        const uint8_t code = byte();
        const bool run = code > 128;
        const int count = run ? code - 128 : code;
        if (count == 0 || count > width_ - x) fail("damaged data: a run exceeds its row");
        const uint8_t repeated = run ? byte() : 0;
        for (const int end = x + count; x < end; ++x) row[x][channel] = run ? repeated : byte();
      }
  }

  // The older encoding: flat texels, among which (1, 1, 1, n) repeats the previous texel n times; n
  // is shifted left by 8 for each directly preceding repeat.
  void readOldRow(std::vector<Rgbe>& row) {
    int shift = 0;
    for (int x = 0; x < width_;) {
      Rgbe texel;
      for (uint8_t& b : texel) b = byte();
      if (texel[0] == 1 && texel[1] == 1 && texel[2] == 1) {
        const int64_t count = shift < 32 ? int64_t(texel[3]) << shift : width_;
        if (x == 0 || count > width_ - x) fail("damaged data: a run exceeds its row");
        std::fill_n(row.begin() + x, count, row[x - 1]);
        x += int(count);
        shift += 8;
      } else {
        row[x++] = texel;
        shift = 0;
      }
    }
  }

  Rgb decode(const Rgbe& t) const {
    if (t[3] == 0) return Rgb(0);
    const double unit = std::ldexp(scale_, t[3] - 136);
    return {float(t[0] * unit), float(t[1] * unit), float(t[2] * unit)};
  }

  std::filesystem::path path_;
  std::vector<uint8_t> bytes_;
  size_t position_ = 0;
  int width_ = 0, height_ = 0;
  bool bottomUp_ = false, rightToLeft_ = false;
  double scale_ = 1;
  HdrComments comments_;
};

Rgbe encode(Rgb color) {
  for (int c = 0; c < 3; ++c)
    if (!(color[c] > 0) || !std::isfinite(color[c])) color[c] = 0;
  const float largest = maxComponent(color);
  if (largest < 1e-38f) return {0, 0, 0, 0};
  int exponent = std::ilogb(largest) + 1;  // largest in [2^(exponent-1), 2^exponent)
  if (std::lround(std::ldexp(largest, 8 - exponent)) == 256) ++exponent;
  exponent = std::min(exponent, 127);
  Rgbe texel;
  for (int c = 0; c < 3; ++c)
    texel[c] = uint8_t(std::min(255L, std::lround(std::ldexp(color[c], 8 - exponent))));
  texel[3] = uint8_t(exponent + 128);
  return texel;
}

void appendRuns(std::vector<uint8_t>& out, const std::vector<Rgbe>& row, int channel) {
  constexpr int kMaxCount = 127, kMinRun = 4;
  const int width = int(row.size());
  const auto runLength = [&](int x) {
    int end = x + 1;
    while (end < width && end - x < kMaxCount && row[end][channel] == row[x][channel]) ++end;
    return end - x;
  };
  for (int x = 0; x < width;) {
    const int run = runLength(x);
    if (run >= kMinRun) {
      out.insert(out.end(), {uint8_t(128 + run), row[x][channel]});
      x += run;
      continue;
    }
    int end = x + 1;
    while (end < width && end - x < kMaxCount && runLength(end) < kMinRun) ++end;
    out.push_back(uint8_t(end - x));
    for (; x < end; ++x) out.push_back(row[x][channel]);
  }
}

}  // namespace

Image readRadianceHdr(const std::filesystem::path& path, HdrComments* comments) {
  Reader reader(path);
  Image image = reader.read();
  if (comments) *comments = reader.takeComments();
  return image;
}

void writeRadianceHdr(const std::filesystem::path& path, const Image& image,
                      const HdrComments& comments) {
  std::string header = "#?RADIANCE\n";
  for (const auto& [name, value] : comments) header += fmt::format("# {}={}\n", name, value);
  header += fmt::format("FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
  std::vector<uint8_t> out(header.begin(), header.end());
  const bool runs = image.width >= kMinRunWidth && image.width <= kMaxRunWidth;
  std::vector<Rgbe> row(image.width);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) row[x] = encode(image.rgb(x, y));
    if (runs) {
      out.insert(out.end(), {2, 2, uint8_t(image.width >> 8), uint8_t(image.width & 255)});
      for (int channel = 0; channel < 4; ++channel) appendRuns(out, row, channel);
    } else {
      for (const Rgbe& texel : row) out.insert(out.end(), texel.begin(), texel.end());
    }
  }
  writeFile(path, out);
}

}  // namespace chromeball
