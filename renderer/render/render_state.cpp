// SPDX-License-Identifier: Apache-2.0
#include "render/render_state.h"

namespace chromeball {

void RenderState::archive(Archive& a) {
  result.archive(a);
  a(done);
  a(wanted);
  a.check(done <= wanted);
  a(finished);
  const TileGrid tiles{result.film.width(), result.film.height()};
  a.check(finished.empty() || finished.size() == tiles.count());
  bool isAdaptive = allocation.has_value();
  a(isAdaptive);
  if (isAdaptive) {
    if (a.reads()) allocation.emplace(result.film.width(), result.film.height());
    allocation->archive(a);
  }
  schedule.archive(a, isAdaptive);
  if (training) training->archive(a);
}

}  // namespace chromeball
