// SPDX-License-Identifier: Apache-2.0
#include "image/io/color_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "image/io/image_format.h"

namespace chromeball {
namespace {

using Curve = std::function<double(double)>;

constexpr size_t kHeaderBytes = 128, kTagDataAt = 8;  // behind a tag's type

uint32_t profileNumber(std::span<const uint8_t> bytes, size_t at, size_t count) {
  return uint32_t(bigEndian(bytes.subspan(at, count)));
}

bool holdsAt(std::span<const uint8_t> bytes, size_t at, std::string_view text) {
  return bytes.size() >= at && textOf(bytes.subspan(at)).starts_with(text);
}

// `count` numbers of the type s15Fixed16Number; empty if the tag is too short.
std::vector<double> fixedNumbers(std::span<const uint8_t> tag, size_t at, size_t count) {
  std::vector<double> numbers;
  for (size_t i = 0; i < count && tag.size() >= at + 4 * count; ++i)
    numbers.push_back(int32_t(profileNumber(tag, at + 4 * i, 4)) / 65536.0);
  return numbers;
}

// curveType (10.6): a power, or a table between whose numbers it is linear.
std::optional<Curve> sampledCurve(std::span<const uint8_t> tag) {
  constexpr size_t kTableAt = kTagDataAt + 4;
  if (tag.size() < kTableAt) return {};
  const size_t count = profileNumber(tag, kTagDataAt, 4);
  if (count == 0) return [](double x) { return x; };
  if (count > (tag.size() - kTableAt) / 2) return {};
  const auto entry = [tag](size_t i) { return double(profileNumber(tag, kTableAt + 2 * i, 2)); };
  if (count == 1) return [power = entry(0) / 256](double x) { return std::pow(x, power); };
  return [entry, count](double x) {
    const double at = x * double(count - 1);
    const size_t i = std::min(size_t(at), count - 2);
    return std::lerp(entry(i), entry(i + 1), at - double(i)) / 65535;
  };
}

// parametricCurveType (10.18): (a x + b)^g + e from d on, c x + f below.
std::optional<Curve> parametricCurve(std::span<const uint8_t> tag) {
  constexpr size_t kNumbers[] = {1, 3, 4, 5, 7}, kNumbersAt = kTagDataAt + 4;
  if (tag.size() < kNumbersAt) return {};
  const uint32_t kind = profileNumber(tag, kTagDataAt, 2);
  if (kind >= std::size(kNumbers)) return {};
  const std::vector<double> n = fixedNumbers(tag, kNumbersAt, kNumbers[kind]);
  if (n.empty()) return {};
  const double g = n[0], a = kind > 0 ? n[1] : 1, b = kind > 0 ? n[2] : 0;
  const double d = kind >= 3 ? n[4] : kind > 0 ? -b / a : -std::numeric_limits<double>::infinity();
  const double c = kind >= 3 ? n[3] : 0;
  const double e = kind == 2 ? n[3] : kind == 4 ? n[5] : 0, f = kind == 4 ? n[6] : e;
  return [=](double x) { return x >= d ? std::pow(a * x + b, g) + e : c * x + f; };
}

std::optional<Curve> curveOf(std::span<const uint8_t> tag) {
  if (holdsAt(tag, 0, "curv")) return sampledCurve(tag);
  if (holdsAt(tag, 0, "para")) return parametricCurve(tag);
  return {};
}

}  // namespace

IccProfile::IccProfile(std::span<const uint8_t> bytes) : bytes_(bytes) {
  constexpr size_t kSpaceAt = 16, kConnectionAt = 20, kSignatureAt = 36;
  isGrey_ = holdsAt(bytes_, kSpaceAt, "GRAY");
  const bool isOfCurves = (isGrey_ || holdsAt(bytes_, kSpaceAt, "RGB ")) &&
                          holdsAt(bytes_, kConnectionAt, "XYZ ") &&
                          holdsAt(bytes_, kSignatureAt, "acsp");
  // Tables take precedence over curves (9.2, tables 27 and 28 there).
  const bool hasTables = std::ranges::any_of(std::array{"A2B0", "A2B1", "D2B0", "D2B1"},
                                             [&](const char* t) { return !tag(t).empty(); });
  if (!isOfCurves || hasTables) bytes_ = {};
}

std::span<const uint8_t> IccProfile::tag(const char* signature) const {
  constexpr size_t kEntriesAt = kHeaderBytes + 4, kEntryBytes = 12;
  if (bytes_.size() < kEntriesAt) return {};
  const size_t count = std::min<size_t>(profileNumber(bytes_, kHeaderBytes, 4),
                                        (bytes_.size() - kEntriesAt) / kEntryBytes);
  for (size_t at = kEntriesAt; at < kEntriesAt + count * kEntryBytes; at += kEntryBytes) {
    if (!holdsAt(bytes_, at, signature)) continue;
    const size_t begin = profileNumber(bytes_, at + 4, 4), size = profileNumber(bytes_, at + 8, 4);
    if (begin > bytes_.size() || size > bytes_.size() - begin) return {};
    return bytes_.subspan(begin, size);
  }
  return {};
}

bool IccProfile::decodesBy(const std::function<float(float)>& toLinear) const {
  // The curves of sRGB that are in use differ by less than a thousandth; a power of 2.2 differs
  // from sRGB by 0.0085.
  constexpr double kTolerance = 0.003;
  constexpr int kSteps = 255;
  const auto isSame = [&](const char* signature) {
    const std::optional<Curve> curve = curveOf(tag(signature));
    for (int i = 0; curve && i <= kSteps; ++i) {
      const double sample = double(i) / kSteps;
      if (!(std::abs((*curve)(sample)-toLinear(float(sample))) <= kTolerance)) return false;
    }
    return curve.has_value();
  };
  return isGrey_ ? isSame("kTRC") : isSame("rTRC") && isSame("gTRC") && isSame("bTRC");
}

bool IccProfile::has(const std::optional<Chromaticities>& primaries) const {
  if (isGrey_) return true;
  // The XYZ of Rec. 709's primaries under D50, as profiles of sRGB state it (F.3 there).
  const glm::dmat3 kRec709(0.4361, 0.2225, 0.0139, 0.3851, 0.7169, 0.0971, 0.1431, 0.0606, 0.7141);
  constexpr double kTolerance = 0.003;
  const std::optional<glm::dmat3> conversion =
      primaries ? toRec709(*primaries) : std::optional(glm::dmat3(1));
  if (!conversion) return false;
  const glm::dmat3 expected = kRec709 * *conversion;
  constexpr const char* kSignatures[] = {"rXYZ", "gXYZ", "bXYZ"};
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> xyz = fixedNumbers(tag(kSignatures[c]), kTagDataAt, 3);
    if (xyz.empty()) return false;
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(xyz[size_t(k)] - expected[c][k]) <= kTolerance)) return false;
  }
  return true;
}

}  // namespace chromeball
