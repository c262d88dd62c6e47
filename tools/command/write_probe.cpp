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
  if (lowerExtension(file) != ".png") return;
  const auto clipped = std::count_if(map.texels.begin(), map.texels.end(),
                                     [](float channel) { return channel > 1; });
  if (clipped > 0)
    warn(fmt::format("{}: {:.3g}% of the channels are above 1, and clipped; an .exr holds them",
                     file, 100. * double(clipped) / double(map.texels.size())));
}

}  // namespace chromeball
