// SPDX-License-Identifier: Apache-2.0
#include "write_probe.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/file.h"
#include "image/io/write_image.h"
#include "messages.h"
#include "probe/load.h"

namespace chromeball {

void writeProbe(const std::string& file, const Image& map, Mapping mapping) {
  writeImage(file, OutputImage{{{"", "RGB", map}}, {{kMappingAttribute, mappingName(mapping)}}});
  const std::string kind = lowerExtension(file);
  const auto percent = [&](auto count) { return 100. * double(count) / double(map.texels.size()); };
  if (kind == ".png" || kind == ".hdr") {
    const auto negative = std::count_if(map.texels.begin(), map.texels.end(),
                                        [](float channel) { return channel < 0; });
    if (negative > 0)
      warn(fmt::format(
          "{}: {:.3g}% of the channels are negative, down to {:.3g}, and become 0; an "
          ".exr holds them",
          file, percent(negative), *std::min_element(map.texels.begin(), map.texels.end())));
  }
  if (kind != ".png") return;
  const auto clipped = std::count_if(map.texels.begin(), map.texels.end(),
                                     [](float channel) { return channel > 1; });
  if (clipped > 0)
    warn(fmt::format("{}: {:.3g}% of the channels are above 1, and clipped; an .exr holds them",
                     file, percent(clipped)));
}

}  // namespace chromeball
