// SPDX-License-Identifier: Apache-2.0
#include "job/render_part.h"

#include "image/io/write_exr.h"

namespace chromeball {

void RenderPart::archive(Archive& a) {
  std::string version = "chromeball " CHROMEBALL_VERSION " 1";
  const std::string own = version;
  a(version);
  if (version != own)
    throwInput("{}: was written by another version of chromeball; render it again", a.name());
  a.startSum();
  a(identity);
  plan.archive(a);
  a.endSum();
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
    result.archive(a);
  };
}

RenderPart readPartHeader(const std::filesystem::path& path) {
  RenderPart part;
  readExrState(
      path, [&](Archive& a) { part.archive(a); }, Checked::No);
  return part;
}

StoredPart readPart(const std::filesystem::path& path) {
  RenderPart part;
  std::optional<RenderResult> result;
  readExrState(path, [&](Archive& a) {
    part.archive(a);
    const Crop window = part.plan.settings.window();
    constexpr uint64_t kLeastPerPixel = 100;  // bytes; before the films are allocated
    a.check(kLeastPerPixel * uint64_t(window.width) * uint64_t(window.height) <= a.left());
    result.emplace(part.plan.settings, part.plan.layers());
    result->archive(a);
  });
  return {std::move(part), std::move(*result)};
}

}  // namespace chromeball
