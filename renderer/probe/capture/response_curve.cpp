// SPDX-License-Identifier: Apache-2.0
#include "probe/capture/exposure.h"

#include <fmt/format.h>

#include <sstream>

#include "base/error.h"
#include "base/file.h"
#include "image/tonemap.h"

namespace chromeball {
namespace {

constexpr const char* kHeader = "level,red,green,blue";

// The next line that is no comment, without the end that other systems write; false at the end.
bool nextLine(std::istream& text, std::string& line) {
  do {
    if (!std::getline(text, line)) return false;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
  } while (line.empty() || line.front() == '#');
  return true;
}

// A line such as "17,0.01,0.02,0.03".
bool parseLine(const std::string& line, int level, dvec3& exposure) {
  std::istringstream text(line);
  text.imbue(std::locale::classic());
  int number = -1;
  text >> number;
  for (int c = 0; c < 3; ++c) {
    char comma = 0;
    text >> comma >> exposure[c];
    if (comma != ',') return false;
  }
  return text && number == level && (text >> std::ws).eof();
}

}  // namespace

double ResponseCurve::logExposure(int channel, double level) const {
  if (kind_ == Kind::Linear) return std::log(level);
  if (kind_ == Kind::Srgb) return std::log(double(srgbToLinear(float(level))));
  const double at = std::min(level, 1.0) * (kLevels - 1);
  const int below = std::min(int(at), kLevels - 2);
  const double low = table_[size_t(below)][channel], high = table_[size_t(below) + 1][channel];
  // A level without exposure has no logarithm to start from: exposure rises linearly from it.
  if (std::isinf(low)) return high + std::log(at - below);
  return glm::mix(low, high, at - below);
}

ResponseCurve ResponseCurve::read(const std::filesystem::path& path) {
  constexpr size_t kMaxBytes = 1 << 20;
  checkReadable(path);
  if (std::filesystem::file_size(path) > kMaxBytes)
    throwInput("{}: is longer than a response curve, which has {} lines", path.string(),
               kLevels + 1);
  const std::vector<uint8_t> bytes = readFile(path);
  std::istringstream text(std::string(bytes.begin(), bytes.end()));
  std::string line;
  const bool hasLine = nextLine(text, line);
  if (line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);  // byte order mark of UTF-8
  if (!hasLine || line != kHeader)
    throwInput("{}: is no response curve; its first line should be `{}`", path.string(), kHeader);
  std::vector<dvec3> logs(kLevels);
  for (int level = 0; level < kLevels; ++level) {
    dvec3 exposure(0);
    if (!nextLine(text, line))
      throwInput("{}: ends before level {}; a response curve has {} levels", path.string(), level,
                 kLevels);
    if (!parseLine(line, level, exposure))
      throwInput("{}: the line of level {} should be `{},` and three numbers with commas between",
                 path.string(), level, level);
    for (int c = 0; c < 3; ++c) {
      // Black may be without exposure.
      if (!(exposure[c] > 0 || (level == 0 && exposure[c] == 0)) || !std::isfinite(exposure[c]))
        throwInput("{}: the exposures of level {} should be above 0", path.string(), level);
      logs[size_t(level)][c] = std::log(exposure[c]);
      if (level > 0 && !(logs[size_t(level)][c] > logs[size_t(level) - 1][c]))
        throwInput("{}: the exposures of level {} should be above those of level {}", path.string(),
                   level, level - 1);
    }
  }
  if (nextLine(text, line)) throwInput("{}: has more than {} levels", path.string(), kLevels);
  return ResponseCurve(std::move(logs));
}

void ResponseCurve::write(const std::filesystem::path& path) const {
  std::string text = std::string(kHeader) + '\n';
  for (int level = 0; level < kLevels; ++level) {
    text += fmt::format("{}", level);
    for (int c = 0; c < 3; ++c)
      text += fmt::format(",{:.9g}", std::exp(logExposure(c, level / double(kLevels - 1))));
    text += '\n';
  }
  writeFile(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace chromeball
