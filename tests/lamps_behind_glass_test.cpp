// SPDX-License-Identifier: Apache-2.0
// The warnings that punctual lights do not pass a surface of glass.
#include <gtest/gtest.h>

#include <fstream>

#include "gltf_writer.h"
#include "run_command.h"

namespace chromeball::lamps_behind_glass_test {
namespace {

using nlohmann::json;

std::string messages(double roughness, double ior, bool isBody, bool hasCoat) {
  GltfWriter w;
  json extensions = {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                     {"KHR_materials_ior", {{"ior", ior}}}};
  if (isBody) extensions["KHR_materials_volume"] = {{"thicknessFactor", 1}};
  if (hasCoat) extensions["KHR_materials_clearcoat"] = {{"clearcoatFactor", 1}};
  w.add("materials",
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", roughness}}},
         {"extensions", extensions}});
  addTriangle(w, {{"material", 0}});
  w.save();
  std::ofstream(w.folder() / "s.toml")
      << "model = 'model.gltf'\n[camera]\nposition = [0.3, 0.3, 2]\nlook_at = [0.3, 0.3, 0]\n"
         "[[light]]\ntype = 'point'\nposition = [0, 0, 3]\nintensity = 5\n";
  return runCommand({"render", w.folder() / "s.toml", "--size", "4x4", "--samples", "1", "-o",
                     w.folder() / "o.exr"})
      .error;
}

bool has(const std::string& text, const char* words) { return text.find(words) != text.npos; }

TEST(LampsBehindGlass, AWarningSaysWhereTheyDoNotPass) {
  const char *bodies = "do not pass smooth bodies", *sheets = "do not pass smooth sheets";
  for (const double roughness : {0.0, 0.009}) {
    EXPECT_TRUE(has(messages(roughness, 1.5, true, false), bodies)) << roughness;
    EXPECT_TRUE(has(messages(roughness, 1.5, false, true), sheets)) << roughness;
    EXPECT_FALSE(has(messages(roughness, 1.5, false, false), "do not pass")) << roughness;
  }
  EXPECT_TRUE(has(messages(0.5, 1, true, false), bodies));
  EXPECT_FALSE(has(messages(0.5, 1.5, true, false), "do not pass"));
  EXPECT_FALSE(has(messages(0.5, 1.5, false, true), "do not pass"));
}

}  // namespace
}  // namespace chromeball::lamps_behind_glass_test
