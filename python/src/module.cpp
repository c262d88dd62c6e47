// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"

NB_MODULE(_core, m) {
  using namespace chromeball::python;
  m.doc() =
      "The renderer's library. Use the package chromeball, which checks arrays and arguments.";
  m.attr("version") = CHROMEBALL_VERSION;
  bindErrors(m);
  bindGeometry(m);
  bindProbe(m);
  bindMaterialBsdf(m);
  bindPlan(m);
  bindResult(m);
  bindSession(m);
  bindStrategy(m);
  bindStudy(m);
}
