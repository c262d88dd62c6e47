// SPDX-License-Identifier: Apache-2.0
// chromeball reference: prints docs/scene-file.md.
#include <fmt/format.h>

#include "commands.h"
#include "front/settings.h"

namespace chromeball {

void addReferenceCommand(Command app) {
  app.addCommand("reference", "Print the page of all keys and options, docs/scene-file.md")
      .callback([] { fmt::print("{}", settingsPage()); });
}

}  // namespace chromeball
