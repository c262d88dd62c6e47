// SPDX-License-Identifier: Apache-2.0
// chromeball reference: prints docs/scene-file.md. For maintainers; --help does not list it.
#include <fmt/format.h>

#include "commands.h"
#include "job/settings_page.h"

namespace chromeball {

void addReferenceCommand(CLI::App& app) {
  app.add_subcommand("reference", "Print the reference page of the scene file")
      ->group("")
      ->callback([] { fmt::print("{}", settingsPage()); });
}

}  // namespace chromeball
