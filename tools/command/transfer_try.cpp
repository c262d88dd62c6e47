// SPDX-License-Identifier: Apache-2.0
// Temporary registration.
#include "basis_vertices.h"
#include "commands.h"
#include "relight_model.h"
#include "rotation_option.h"

namespace chromeball {
void addTransferTry(CLI::App& app);
void addTransferTry(CLI::App& app) {
  const auto b = std::make_shared<BasisVerticesOptions>();
  CLI::App* command = app.add_subcommand("basis-vertices", "temporary");
  addSceneOptions(*command, *b, SceneCommand::Bake);
  command->add_option("--basis", b->basis);
  command->add_option("-o", b->output)->required();
  command->callback([b] { runBasisVertices(*b); });
  const auto r = std::make_shared<RelightModelOptions>();
  command = app.add_subcommand("relight-model", "temporary");
  command->add_option("MODEL", r->model)->required();
  command->add_option("--probe", r->probe)->required();
  command->add_option("--keep", r->keep);
  command->add_option("--mapping", r->mapping);
  command->add_option("--scale", r->scale);
  command->add_option("--white", r->white);
  command->add_option("-o", r->output)->required();
  addRotationOption(*command, r->rotation);
  command->callback([r] { runRelightModel(*r); });
}
}  // namespace chromeball
