// SPDX-License-Identifier: Apache-2.0
#include "image/io/conversion_note.h"

#include <fmt/format.h>

namespace chromeball {

Message conversionNote(const std::filesystem::path& path, const Chromaticities& from) {
  return {Message::Kind::Note,
          fmt::format("{}: its colour is converted to Rec. 709 from red ({:.4g}, {:.4g}), green "
                      "({:.4g}, {:.4g}), blue ({:.4g}, {:.4g}), white ({:.4g}, {:.4g})",
                      path.string(), from.red.x, from.red.y, from.green.x, from.green.y,
                      from.blue.x, from.blue.y, from.white.x, from.white.y)};
}

}  // namespace chromeball
