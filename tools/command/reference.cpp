// SPDX-License-Identifier: Apache-2.0
// chromeball reference: prints docs/scene-file.md. For maintainers; --help does not list it.
#include <fmt/format.h>

#include "commands.h"
#include "front/settings_page.h"

namespace chromeball {

void addReferenceCommand(Command app) {
  app.addCommand("reference", "Print the reference page of the scene file").hidden().callback([] {
    fmt::print("{}", settingsPage());
  });
}

}  // namespace chromeball
