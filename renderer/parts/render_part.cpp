// SPDX-License-Identifier: Apache-2.0
#include "parts/render_part.h"

#include <algorithm>

#include "base/error.h"
#include "image/io/exr_state.h"

namespace chromeball {
namespace {

// Whether it can be shown in a message.
bool isPlainText(const std::string& text) {
  return text.size() < 32 && std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

void RenderPart::archive(Archive& a) {
  std::string version = "chromeball " CHROMEBALL_VERSION " 2";
  const std::string own = version;
  a(version);
  if (version != own)
    throwInput("{}: was written by another version of chromeball{}; render it again", a.name(),
               isPlainText(version) ? fmt::format(" ({}; this is {})", version, own) : "");
  a(identity);
  plan.archive(a);
  constexpr int kMaxSide = 65536;
  const auto& s = plan.settings;
  const Crop w = s.window();
  a.check(s.width > 0 && s.height > 0 && s.width <= kMaxSide && s.height <= kMaxSide &&
          s.shard.count > 0 && s.shard.index < s.shard.count && w.x >= 0 && w.y >= 0 &&
          w.width > 0 && w.height > 0 && w.width <= s.width - w.x && w.height <= s.height - w.y);
}

std::function<void(Archive&)> partState(RenderPart& part, RenderResult& result) {
  return [&](Archive& a) {
    part.archive(a);
    part.plan.archiveImages(a);
    result.archive(a);
  };
}

RenderPart readPartHeader(const std::filesystem::path& path) {
  RenderPart part;
  readExrState(path, [&](Archive& a) { part.archive(a); });
  return part;
}

}  // namespace chromeball
