// SPDX-License-Identifier: Apache-2.0
// ICC profiles of curves (ISO 15076-1).
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace chromeball {

using IccBytes = std::vector<uint8_t>;

inline IccBytes iccNumber(uint64_t value, int bytes) {
  IccBytes out;
  while (bytes-- > 0) out.push_back(uint8_t(value >> 8 * bytes));
  return out;
}
inline void append(IccBytes& to, const IccBytes& more) {
  to.insert(to.end(), more.begin(), more.end());
}
inline IccBytes iccText(const std::string& text) { return {text.begin(), text.end()}; }

// s15Fixed16Numbers behind the type of a tag.
inline IccBytes iccFixed(const std::string& type, const std::vector<double>& numbers) {
  IccBytes tag = iccText(type);
  append(tag, iccNumber(0, 4));
  for (const double x : numbers)
    append(tag, iccNumber(uint32_t(int32_t(std::lround(x * 65536))), 4));
  return tag;
}

// curveType: none of the numbers is the identity, one a power (multiplied by 256), more a table.
inline IccBytes iccCurve(const std::vector<int>& numbers) {
  IccBytes tag = iccText("curv");
  append(tag, iccNumber(0, 4));
  append(tag, iccNumber(numbers.size(), 4));
  for (const int number : numbers) append(tag, iccNumber(uint64_t(number), 2));
  return tag;
}
inline IccBytes iccParametric(int kind, const std::vector<double>& numbers) {
  IccBytes tag = iccFixed("para", numbers), head = iccNumber(uint64_t(kind), 2);
  append(head, iccNumber(0, 2));
  tag.insert(tag.begin() + 8, head.begin(), head.end());
  return tag;
}
inline IccBytes iccSrgbCurve() {
  return iccParametric(3, {2.4, 1 / 1.055, .055 / 1.055, 1 / 12.92, .04045});
}

// The XYZ of red, green and blue under D50.
using IccColorants = std::vector<std::vector<double>>;
inline const IccColorants kIccSrgb = {
    {.43607, .22249, .01392}, {.38515, .71687, .09708}, {.14307, .06061, .71410}};
inline const IccColorants kIccDisplayP3 = {
    {.51512, .24120, -.00105}, {.29198, .69225, .04189}, {.15710, .06657, .78407}};

inline IccBytes iccProfile(const std::vector<std::pair<std::string, IccBytes>>& tags,
                           const std::string& space = "RGB ") {
  IccBytes head(128), table = iccNumber(tags.size(), 4), data;
  const auto put = [&](size_t at, const std::string& text) {
    std::copy(text.begin(), text.end(), head.begin() + std::ptrdiff_t(at));
  };
  put(12, "mntr" + space + "XYZ "), put(36, "acsp");
  for (const auto& [signature, tag] : tags) {
    append(table, iccText(signature));
    append(table, iccNumber(128 + 4 + 12 * tags.size() + data.size(), 4));
    append(table, iccNumber(tag.size(), 4));
    append(data, tag);
    data.resize((data.size() + 3) / 4 * 4);
  }
  append(head, table), append(head, data);
  const IccBytes size = iccNumber(head.size(), 4);
  std::copy(size.begin(), size.end(), head.begin());
  return head;
}

inline IccBytes iccProfile(const IccBytes& curve, const IccColorants& colorants = kIccSrgb,
                           const std::vector<std::pair<std::string, IccBytes>>& more = {}) {
  std::vector<std::pair<std::string, IccBytes>> tags = {{"desc", iccText("text sRGB IEC61966-2.1")},
                                                        {"rTRC", curve},
                                                        {"gTRC", curve},
                                                        {"bTRC", curve}};
  for (int c = 0; c < 3; ++c)
    tags.emplace_back(std::string(1, "rgb"[c]) + "XYZ", iccFixed("XYZ ", colorants[size_t(c)]));
  tags.insert(tags.end(), more.begin(), more.end());
  return iccProfile(tags);
}

}  // namespace chromeball
