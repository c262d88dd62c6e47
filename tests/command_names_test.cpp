// SPDX-License-Identifier: Apache-2.0
// One word for one thing over all commands: names of options, options given again, --quiet and
// --progress, the brief help, and what is said about words of other programs.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "regular_expression.h"
#include "run_command.h"

namespace chromeball::command_names_test {
namespace {

using Words = std::vector<std::string>;

const std::string kDusk = std::string(kSourceDir) + "/probes/dusk.exr";
const std::string kPillars = std::string(kSourceDir) + "/scenes/models/pillars.gltf";

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::string helpOf(const Words& command) {
  return runCommand(with(command, {"--help", "all"})).out;
}

// All commands without commands below them.
std::vector<Words> commandsBelow(const Words& command) {
  const std::string help = helpOf(command);
  const size_t list = help.find("\nSubcommands:\n");
  if (list == std::string::npos) return {command};
  std::vector<Words> all;
  for (const Captures& name : allMatches(help.substr(list), "\n  ([a-z-]+) "))
    for (const Words& below : commandsBelow(with(command, {name[1]}))) all.push_back(below);
  return all;
}

const std::vector<Words>& allCommands() {
  static const std::vector<Words> kAll = commandsBelow({});
  return kAll;
}

bool shows(const std::string& help, const std::string& option) {
  return containsMatch(help, "\n  (-\\w,)?" + option + "[ \n]");
}

// Whether the command knows the options: the one after them is the first unknown one.
void expectKnown(const Words& command, const Words& options) {
  const std::string error = runCommand(with(with(command, options), {"--no-such-option"})).error;
  EXPECT_NE(error.find("unknown option `--no-such-option`"), std::string::npos)
      << command.back() << ": " << error;
}

TEST(SlowCommandNames, SynonymsAreKnownToAllCommandsAndShownByNone) {
  const std::pair<std::string, Words> kSynonyms[] = {
      {"--probe-mapping", {"--mapping", "auto", "--from", "auto"}},
      {"--probe-rotation", {"--rotation", "30"}},
      {"--probe-scale", {"--scale", "2"}}};
  ASSERT_GT(allCommands().size(), 30u);
  int found = 0;
  for (const Words& command : allCommands()) {
    const std::string help = helpOf(command);
    for (const auto& [option, synonyms] : kSynonyms) {
      for (size_t i = 0; i < synonyms.size(); i += 2)
        EXPECT_FALSE(shows(help, synonyms[i])) << command.back() << " " << synonyms[i];
      if (!shows(help, option)) continue;
      ++found;
      expectKnown(command, synonyms);
    }
  }
  EXPECT_GT(found, 30);
}

TEST(SlowCommandNames, CommandsThatWriteFilesHaveQuietAndProgress) {
  const Words kReaders{"info", "reflectivity", "doctor", "reference"};
  for (const Words& command : allCommands()) {
    const bool isReader = std::ranges::count(kReaders, command.back()) > 0;
    const std::string help = helpOf(command);
    EXPECT_EQ(shows(help, "--quiet"), !isReader) << command.back();
    EXPECT_EQ(shows(help, "--progress"), !isReader) << command.back();
  }
}

TEST(SlowCommandNames, QuietSilencesResultsAndProgressShowsABar) {
  const TemporaryFolder folder;
  const Words align{"probe", "align", kDusk, kDusk};
  EXPECT_NE(runCommand(align).out.find("rotation"), std::string::npos);
  EXPECT_EQ(runCommand(with(align, {"--quiet"})).out, "");
  EXPECT_NE(runCommand(with(align, {"--quiet", "--json"})).out.find("{"), std::string::npos);
  const std::string noisy = folder / "noisy.exr";
  ASSERT_EQ(runCommand({"render", kPillars, "--probe", kDusk, "--size", "16x12", "--samples", "4",
                        "--aov", "denoise", "-o", noisy})
                .status,
            0);
  const Words denoise{"image", "denoise", noisy, folder / "a.exr"};
  EXPECT_NE(runCommand(denoise).out, "");
  EXPECT_EQ(runCommand(denoise).error, "");
  EXPECT_EQ(runCommand(with(denoise, {"--quiet"})).out, "");
  EXPECT_NE(runCommand(with(denoise, {"--progress"})).error.find("denoising  ["),
            std::string::npos);
}

TEST(SlowCommandNames, OfOptionsGivenAgainTheLastCountsAndListsGrow) {
  const TemporaryFolder folder;
  const auto convert = [&](const Words& more) {
    const std::string out = folder / "converted.exr";
    EXPECT_EQ(runCommand(with({"probe", "convert", kDusk, out, "--to", "angular"}, more)).status,
              0);
    return readImage(out);
  };
  const Image turned = convert({"--size", "8x8", "--probe-rotation", "90"});
  EXPECT_EQ(turned.width, 8);
  EXPECT_EQ(
      convert({"--size", "4x4", "--rotation", "30", "--size", "8x8", "--rotation", "90"}).texels,
      turned.texels);
  EXPECT_NE(convert({"--size", "8x8"}).texels, turned.texels);

  const std::string groups = folder / "groups.exr";
  ASSERT_EQ(runCommand({"render", kPillars, "--probe", std::string(kSourceDir) + "/probes/noon.exr",
                        "--size", "8x6", "--samples", "1", "--samples", "2", "--aov",
                        "light_groups", "--aov", "albedo", "-o", groups})
                .status,
            0);
  const ImageFile file = readImageFile(groups);
  EXPECT_EQ(metadataNumber(file.metadata, "samples"), 2);
  EXPECT_TRUE(findLayer(file, "light.probe") && findLayer(file, "albedo"));
  const auto mixed = [&](const Words& gains) {
    const std::string out = folder / "mixed.exr";
    EXPECT_EQ(runCommand(with({"image", "relight", groups, "-o", out}, gains)).status, 0);
    return readImage(out).texels;
  };
  const auto both = mixed({"--gain", "probe.suns=2,probe=1,0.5,0.25"});
  EXPECT_EQ(mixed({"--gain", "probe.suns=2", "--gain", "probe=1,0.5,0.25"}), both);
  EXPECT_NE(mixed({"--gain", "probe.suns=2"}), both);
}

TEST(CommandNames, TheBriefHelpHasTheCommonOptionsAfterExamples) {
  const std::string brief = runCommand({"render", "--help"}).out;
  const size_t options = brief.find("\nCommon options:\n"), examples = brief.find("\nExamples:\n");
  ASSERT_NE(options, std::string::npos);
  EXPECT_LT(examples, options);
  EXPECT_EQ(allMatches(brief.substr(options), "\n  (?:-\\w,)?--").size(), 15u);
  EXPECT_EQ(allMatches(brief.substr(examples, options - examples), "\n  chromeball ").size(), 2u);
  EXPECT_LT(std::ranges::count(brief, '\n'), 80);
  EXPECT_NE(brief.find("render --help all"), std::string::npos);
  EXPECT_FALSE(shows(brief, "--shutter"));
  EXPECT_TRUE(shows(helpOf({"render"}), "--shutter"));
  EXPECT_TRUE(shows(runCommand({"bake", "--help"}).out, "--white"));  // its own
  EXPECT_NE(runCommand({"--help"}).out.find("\n  reference "), std::string::npos);
}

TEST(CommandNames, WordsOfOtherProgramsAreUnderstoodInOptionsAndKeys) {
  const TemporaryFolder folder;
  const std::string scene = folder / "scene.toml";
  const auto expectHint = [&](const std::string& toml, const std::string& hint) {
    std::ofstream(scene) << "model = '" << kPillars << "'\n" << toml;
    expectError({"render", scene, "-o", folder / "a.exr"}, hint);
  };
  expectHint("[render]\nspp = 4\n", "did you mean `samples`?");
  expectHint("[output]\nSPP = 4\n", "did you mean `samples` in [render]?");
  expectHint("[render]\nresolution = [4, 4]\n", "did you mean `size`?");
  expectHint("[environment]\nfile = 'a.hdr'\n", "did you mean [probe]?");
  expectHint("[material]\ncolor = 1\n", "materials are those of the model");
  expectHint("[render]\nlamp = 1\n", "[[light]]");
  expectHint("[output]\nsize = [4, 4]\n", "did you mean `size` in [render]?");
  expectHint("[camera]\nfocal_length = 50\n", "did you mean `fov`?");
  expectHint("[camera]\nfstop = 2\n", "`aperture` and `focus` in [camera]");
  expectHint("[render]\nfov = 40\n", "did you mean `fov` in [camera]?");
  expectHint("[[light]]\nbrightness = 1\n", "one key, of a number");  // not the probe's scale
  expectHint("[output]\ntonemap = 'ACES'\n", "did you mean `aces`?");
  const auto expectOption = [&](const std::string& option, const std::string& hint) {
    expectError({"render", kPillars, option, "1"}, hint);
  };
  expectOption("--light", "lamps are [[light]]");
  expectOption("--material", "materials are those of the model");
  expectOption("--gpu", "renders run on the processor");
  expectOption("--sensor", "did you mean `--fov");
  expectOption("--sample_count", "did you mean `--samples N`?");
  expectOption("--rotaton", "did you mean `--probe-rotation`?");
  expectError({"probe", "convert", "--mappin", "a"}, "did you mean `--probe-mapping`?");
  expectError({"probe", "convert", "--wattage", "a"},
              "unknown option `--wattage`; known: --help, ");
}

TEST(CommandNames, OptionsThatNoProgramSharesAreFoundByTheirMeaning) {
  const auto expectOption = [&](const std::string& option, const std::string& hint) {
    expectError({"render", kPillars, option, "1"}, "unknown option `" + option + "`; " + hint);
  };
  expectOption("--engine", "did you mean `--integrator NAME`?");
  expectOption("--passes", "did you mean `--aov NAME,...`?");
  expectOption("--layers", "did you mean `--aov NAME,...`?");
  expectOption("--wireframe", "surfaces are rendered, not their edges");
  for (const char* lookAt : {"--lookat", "--look_at", "--LookAt"})
    expectOption(lookAt, "did you mean `--look-at`?");
  for (const char* floor : {"--floor", "--ground-plane"})
    expectOption(floor, "did you mean `--ground=HEIGHT`?");
  for (const char* shadow : {"--shadow", "--shadows"})
    expectOption(shadow, "did you mean `--shadow-catcher NODE,...`?");
  expectOption("--probe-intensity", "did you mean `--probe-scale R[,G,B]`?");
  for (const char* verbose : {"--verbose", "-v"})
    expectOption(verbose, "did you mean `--progress`?");
  expectOption("--silent", "did you mean `--quiet`?");
  expectOption("--format", "the ending of an image's name decides its format: --output");
  expectError({"compare", kPillars, "--quality", "final"}, "did you mean `--samples`?");
}

TEST(CommandNames, TablesAndKeysOfListsAreFoundByTheirMeaning) {
  const TemporaryFolder folder;
  const std::string scene = folder / "scene.toml";
  const auto expectHint = [&](const std::string& toml, const std::string& hint) {
    std::ofstream(scene) << toml;
    expectError({"render", scene, "-o", folder / "a.exr"}, "; " + hint);
  };
  const std::string model = "[[model]]\nfile = '" + kPillars + "'\n";
  expectHint(model + "[[lights]]\ntype = 'sun'\n", "did you mean [[light]]?");
  expectHint("lights = 0\n" + model, "did you mean `lights` in [lighting]?");
  expectHint(model + "[cameras]\nfov = 40\n", "did you mean [camera]?");
  expectHint(model + "position = [0, 1, 0]\n", "did you mean `translation`?");
  expectHint(model + "[composite]\nfloor = true\n", "did you mean `ground`?");
  expectHint(model + "[render]\nverbose = true\n", "known: ");  // an option, and no setting
  expectHint(model + "[render]\nclamp_direct = 1\n", "did you mean the option --clamp?");
  for (const char* strength : {"color", "strength", "energy"})
    expectHint(model + "[[light]]\n" + strength + " = 1\n",
               "colour and strength are one key, of a number or three: `intensity` or `power`");
  expectHint(model + "[[light]]\ntype = 'directional'\n", "did you mean `sun`?");
  expectHint(model + "[[light]]\ntype = 'area'\n", "did you mean `disc`?");
  expectHint(model + "[[light]]\ntype = 'dome'\n", "an environment is a probe");
  expectHint(model + "[composite]\nshadow = 1\n", "did you mean the option --shadow-catcher?");
  expectHint(model + "[lighting]\nstrategy = 'mis'\n", "multiple importance sampling is");
}

TEST(CommandNames, ValuesAreFoundByTheirMeaning) {
  const auto expectHint = [&](const Words& options, const std::string& hint) {
    expectError(with({"render", kPillars}, options), hint);
  };
  expectHint({"--strategy", "mis"}, "`mis` is not known; multiple importance sampling is");
  expectHint({"--strategy", "mis"}, "see --mis");
  expectHint({"--quality", "high"}, "did you mean `final`?");
  expectHint({"--quality", "preview"}, "did you mean `draft`?");
  expectHint({"--quality", "dreft"}, "did you mean `draft`?");
  expectHint({"--denoise", "false"}, "did you mean `--denoise=false`?");
  expectHint({"--denoise", "off"}, "did you mean `--denoise=false`?");
  expectHint({"--view", "fornt"}, "or front, back, left, right, above or below");
  expectError({"render", "--denoise", "on", kPillars}, "did you mean `--denoise=true`?");
  expectError({"compare", kPillars, "--denoise", "off"}, "unknown option `--denoise`");
}

TEST(CommandNames, FilesInPlaceOfCommandsGetACommand) {
  const std::string scene = std::string(kSourceDir) + "/scenes/demo.toml";
  expectError({kPillars, "--probe", kDusk}, "did you mean `chromeball render " + kPillars + "`?");
  expectError({scene}, "did you mean `chromeball render " + scene + "`?");
  expectError({kDusk}, "did you mean `chromeball probe info " + kDusk + "`?");
  expectError({"probe", kDusk}, "did you mean `chromeball probe info " + kDusk + "`?");
  expectError({"image", kDusk}, "did you mean `chromeball image view " + kDusk + " OUT.png`?");
  expectError({"probe", "inf"}, "unknown command `inf`; did you mean `info`?");
  expectError({"info", scene}, "a scene file: `chromeball render` shows it");
}

}  // namespace
}  // namespace chromeball::command_names_test
