// SPDX-License-Identifier: Apache-2.0
#include "image/io/radiance_hdr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/file.h"
#include "base/progress.h"
#include "image/io/image_format.h"
#include "image/size_limits.h"

namespace chromeball {
namespace {

using Rgbe = std::array<uint8_t, 4>;

// The widths that the newer run-length encoding allows.
constexpr int kMinRunWidth = 8, kMaxRunWidth = 32767;

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path), bytes_(readFile(path)) {}

  RadianceHdr read() {
    readHeader();
    checkFileLength();
    Image image(areColumns_ ? height_ : width_, areColumns_ ? width_ : height_, 3);
    std::vector<Rgbe> row(width_);
    for (int y = 0; y < height_; ++y) {
      endIfCancelled();
      readRow(row);
      for (int x = 0; x < width_; ++x) {
        const int u = reversesRows_ ? width_ - 1 - x : x, v = reversesOrder_ ? height_ - 1 - y : y;
        image.setRgb(areColumns_ ? v : u, areColumns_ ? u : v, decode(row[x]));
      }
    }
    return {std::move(image), primaries_, std::move(comments_), std::move(messages_)};
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throwInput("{}: {}", path_.string(), what);
  }

  std::string_view line() {
    const std::string_view rest = textOf(bytes_).substr(position_);
    const size_t end = rest.find('\n');
    if (end == std::string_view::npos) fail("the Radiance header does not end");
    constexpr size_t kLongest = 1 << 20;  // programs note their command lines in the header
    if (end > kLongest) fail("a line of the Radiance header has more than 2^20 characters");
    position_ += end + 1;
    return rest.substr(0, end);
  }

  void readHeader() {
    if (!line().starts_with("#?")) fail("not a Radiance HDR file");
    for (std::string_view text = line(); !text.empty() && text != "\r"; text = line())
      readVariable(text);
    sayRepeated();
    if (!(exposure_ > 1e-20 && exposure_ < 1e20)) fail("EXPOSURE must be a positive number");
    if (exposure_ != 1)
      say(Message::Kind::Note, fmt::format("its texels are divided by EXPOSURE={:g}", exposure_));
    if (correction_ != glm::dvec3(1))
      say(Message::Kind::Note, fmt::format("its texels are divided by COLORCORR={:g} {:g} {:g}",
                                           correction_.x, correction_.y, correction_.z));
    for (int c = 0; c < 3; ++c) {
      if (!(correction_[c] > 1e-20 && correction_[c] < 1e20))
        fail("COLORCORR must be three positive numbers");
      scale_[c] = 1 / exposure_ / correction_[c];
    }

    readResolution(std::string(line()));
  }

  // The number of rows, then their length. Rows may also be columns: +X first.
  void readResolution(const std::string& text) {
    char order[3] = {}, direction[3] = {}, rows[32] = {}, length[32] = {};
    std::sscanf(text.c_str(), "%2s %31s %2s %31s", order, rows, direction, length);
    areColumns_ = order[1] == 'X';
    const bool isKnown =
        isSign(order[0]) && isSign(direction[0]) &&
        (areColumns_ ? direction[1] == 'Y' : order[1] == 'Y' && direction[1] == 'X');
    if (!isKnown) failResolution();
    const int64_t height = sideOf(rows), width = sideOf(length);
    checkImageSize(path_, width, height, 3);
    checkImageMemory(path_, width, height, 3);
    height_ = int(height);
    width_ = int(width);
    const char left = areColumns_ ? order[0] : direction[0],
               up = areColumns_ ? direction[0] : order[0];
    reversesOrder_ = areColumns_ ? left == '-' : up == '+';
    reversesRows_ = areColumns_ ? up == '+' : left == '-';
  }

  static bool isSign(char c) { return c == '+' || c == '-'; }

  [[noreturn]] void failResolution() const {
    fail("the resolution line should read: -Y height +X width");
  }

  // A number beyond 64 bits becomes the nearest, which is too large as well.
  int64_t sideOf(const char* word) const {
    char* end = nullptr;
    const int64_t side = std::strtoll(word, &end, 10);
    if (end == word || *end) failResolution();
    return side;
  }

  void addComment(std::string_view text) {
    const size_t equals = text.find('=');
    if (equals == std::string_view::npos) return;
    const std::string_view value = text.substr(equals + 1);
    comments_[std::string(text.substr(0, equals))] = value.substr(0, value.find('\r'));
  }

  // Real files have lines without meaning: PRIMARIES=0 0 0 0 0 0 0 0, GAMMA=1.
  void readVariable(std::string_view text) {
    if (text.starts_with("# ")) return addComment(text.substr(2));
    const size_t equals = text.find('=');
    if (equals == std::string_view::npos || text.starts_with('#')) return;
    const std::string name(text.substr(0, equals));
    const std::vector<double> numbers = numbersOf(text.substr(equals + 1));
    const auto isOnly = [&](double number) { return numbers.size() == 1 && numbers[0] == number; };
    if (name == "FORMAT") {
      if (text.find("32-bit_rle_rgbe") == std::string_view::npos)
        fail("unsupported FORMAT; it must be 32-bit_rle_rgbe");
    } else if (name == "EXPOSURE") {
      exposure_ *= numbers.size() == 1 ? numbers[0] : 0;
    } else if (name == "COLORCORR") {
      if (numbers.size() != 3) fail("COLORCORR must be three positive numbers");
      correction_ *= glm::dvec3(numbers[0], numbers[1], numbers[2]);
    } else if (name == "PRIMARIES") {
      const std::vector<double>& n = numbers;
      if (n.size() != 8)
        return sayOnce(Message::Kind::Warning,
                       "PRIMARIES, which are not eight numbers, are ignored");
      if (std::ranges::all_of(n, [](double number) { return number == 0; })) return;
      primaries_ = Chromaticities{{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
    } else if (name == "GAMMA") {
      if (!isOnly(1))
        sayOnce(Message::Kind::Warning, "GAMMA is ignored: texels are taken as linear");
    } else if (name == "PIXASPECT") {
      if (!isOnly(1))
        sayOnce(Message::Kind::Warning, "PIXASPECT is ignored: texels are taken as square");
    } else if (name == "VIEW") {
      sayOnce(Message::Kind::Note, "VIEW is ignored: the mapping is not taken from it");
    }
  }

  // None if there is anything else.
  static std::vector<double> numbersOf(std::string_view text) {
    const std::string copy(text);
    std::vector<double> numbers;
    char* end = nullptr;
    for (const char* at = copy.c_str();; at = end) {
      const double number = std::strtod(at, &end);
      if (end == at)
        return std::string_view(at).find_first_not_of(" \t\r") == std::string_view::npos
                   ? numbers
                   : std::vector<double>();
      numbers.push_back(number);
    }
  }

  void say(Message::Kind kind, const std::string& what) {
    messages_.push_back({kind, path_.string() + ": " + what});
  }

  // Messages about lines that the header may repeat without end are reported once, with the number
  // of lines, after the header.
  void sayOnce(Message::Kind kind, const std::string& what) { ++repeated_[{kind, what}]; }

  void sayRepeated() {
    for (const auto& [said, lines] : repeated_)
      say(said.first, lines == 1 ? said.second : fmt::format("{} ({} lines)", said.second, lines));
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
    Rgb color;
    for (int c = 0; c < 3; ++c) color[c] = float(t[c] * std::ldexp(scale_[c], t[3] - 136));
    return color;
  }

  std::filesystem::path path_;
  std::vector<uint8_t> bytes_;
  size_t position_ = 0;
  int width_ = 0, height_ = 0;  // of the rows, as they are stored
  bool areColumns_ = false, reversesOrder_ = false, reversesRows_ = false;
  double exposure_ = 1;  // the products of EXPOSURE and COLORCORR
  glm::dvec3 correction_{1}, scale_{1};
  std::optional<Chromaticities> primaries_;
  std::map<std::pair<Message::Kind, std::string>, int> repeated_;
  Messages messages_;
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

RadianceHdr readRadianceHdr(const std::filesystem::path& path) { return Reader(path).read(); }

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
