// SPDX-License-Identifier: Apache-2.0
// chromeball compare.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "base/json.h"
#include "gltf_writer.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "json_file.h"
#include "probe/synth.h"
#include "regular_expression.h"
#include "run_command.h"
#include "small_model.h"

namespace chromeball::command_compare_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;
namespace fs = std::filesystem;

// A triangle under a gradient probe, rendered at 16 x 16 pixels.
class SlowCommandCompare : public testing::Test {
 protected:
  SlowCommandCompare() {
    writeSmallModel(folder_ / "plate.gltf");
    writeImage(folder_ / "probe.exr", gradientProbe({32, 16}, Rgb(0.5f), {0.3, 0.6, 0.6}));
  }

  std::vector<std::string> command(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"compare", folder_ / "plate.gltf",
                                 "--probe", folder_ / "probe.exr",
                                 "--size",  "16x16",
                                 "-o",      dir(),
                                 "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::string dir() const { return folder_ / "report"; }
  json results() const { return jsonOfFile(dir() + "/results.json"); }
  std::map<fs::path, fs::file_time_type> renders() const {
    std::map<fs::path, fs::file_time_type> found;
    for (const auto& entry : fs::directory_iterator(dir() + "/renders"))
      found[entry.path()] = entry.last_write_time();
    return found;
  }

  TemporaryFolder folder_;
};

const std::vector<std::string> kSmall = {"--strategies",        "bsdf,importance,median-cut:4",
                                         "--samples",           "1,4",
                                         "--repeats",           "3",
                                         "--reference-samples", "64"};

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

// Settings that a comparison does not take from the scene file, and settings that it varies anyway.
TEST_F(SlowCommandCompare, NamesSettingsThatItDoesNotHeed) {
  std::ofstream(folder_ / "s.toml")
      << "model = 'plate.gltf'\n[probe]\nfile = 'probe.exr'\n[lighting]\nstrategy = 'uniform'\n"
         "[render]\nsamples = 3\nnoise = 3\nintegrator = 'direct'\nmax_depth = 2\ndenoise = true\n";
  const CommandResult result =
      runCommand({"compare", folder_ / "s.toml", "--size", "8x8", "-o", dir(), "--quiet",
                  "--strategies", "bsdf", "--samples", "1", "--reference-samples", "64"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.error.find("s.toml:11: render.denoise, render.integrator have no effect here"),
            std::string::npos)
      << result.error;
}

// Rows that differ only in what their integrator does not use.
TEST_F(SlowCommandCompare, RendersEqualRowsOnce) {
  const CommandResult result = runCommand({"compare",
                                           folder_ / "plate.gltf",
                                           "--probe",
                                           folder_ / "probe.exr",
                                           "--size",
                                           "8x8",
                                           "-o",
                                           dir(),
                                           "--strategies",
                                           "uniform,importance,median-cut:8,suns",
                                           "--integrators",
                                           "environment-map,direct",
                                           "--baseline",
                                           "importance+environment-map",
                                           "--samples",
                                           "1",
                                           "--repeats",
                                           "3",
                                           "--reference-samples",
                                           "64"});
  EXPECT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.error.find("importance+environment-map, median-cut:8+environment-map are the "
                              "same image as uniform+environment-map, which is compared alone"),
            std::string::npos)
      << result.error;
  std::set<std::string> names;
  const json found = results();
  for (const json& strategy : found["strategies"]) names.insert(strategy["name"]);
  EXPECT_EQ(names,
            (std::set<std::string>{"uniform+environment-map", "uniform+direct", "importance+direct",
                                   "median-cut:8+direct", "suns+environment-map", "suns+direct"}));
  EXPECT_EQ(found["baseline"], "uniform+environment-map");
}

TEST_F(SlowCommandCompare, writesAllResultsAndContinues) {
  ASSERT_EQ(runCommand(command(kSmall)).status, 0);
  const json first = results();
  EXPECT_TRUE(first["complete"]);
  ASSERT_EQ(first["strategies"].size(), 3u);
  for (const json& strategy : first["strategies"]) {
    ASSERT_EQ(strategy["cells"].size(), 2u);
    EXPECT_EQ(strategy["unbiased"], strategy["name"] != "median-cut:4");
    for (const json& cell : strategy["cells"]) {
      EXPECT_GT(cell["relmse"]["mean"], 0);
      EXPECT_GT(cell["seconds"]["mean"], 0);
    }
  }
  EXPECT_EQ(first["agreement"].size(), 1u) << "one pair of unbiased strategies";
  const std::string csv = fileContents(dir() + "/results.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 2);
  // The baseline is the best unbiased row; the CSV and the page's example name the same columns.
  for (const json& strategy : first["strategies"]) {
    const json& efficiency = strategy["cells"][1]["efficiency"]["mean"];
    if (strategy["name"] == first["baseline"]) {
      EXPECT_EQ(efficiency, 1);
    }
    if (strategy["unbiased"]) {
      EXPECT_LE(efficiency, 1) << strategy["name"];
    }
  }
  EXPECT_NE(first["baseline"], "median-cut:4");
  const std::string page = fileContents(dir() + "/index.html");
  const std::string example = page.substr(page.find("<pre id=\"example\">"), 600);
  for (const char* column : {"strategy", "unbiased", "budget", "relmse", "seconds", "efficiency",
                             "efficiency_low", "efficiency_high", "missed_light"}) {
    EXPECT_NE(example.find(column), std::string::npos) << column;
    EXPECT_NE(("," + csv.substr(0, csv.find('\n')) + ",").find(fmt::format(",{},", column)),
              std::string::npos)
        << column;
  }

  // The same command renders nothing; one more repeat renders only the new images.
  const auto before = renders();
  EXPECT_EQ(before.size(), 8u + 3 * 2 * 3);
  std::ofstream(dir() + "/notes.txt") << "mine";
  ASSERT_EQ(runCommand(command(kSmall)).status, 0);
  EXPECT_EQ(renders(), before);
  EXPECT_EQ(results()["strategies"], first["strategies"]);
  std::vector<std::string> more = kSmall;
  more[5] = "4";
  ASSERT_EQ(runCommand(command(more)).status, 0);
  EXPECT_EQ(renders().size(), before.size() + 3 * 2);
  for (const auto& [path, time] : before) EXPECT_EQ(renders()[path], time) << path;
  EXPECT_EQ(fileContents(dir() + "/notes.txt"), "mine");
}

TEST_F(SlowCommandCompare, interruptedRunKeepsItsRenders) {
  const std::vector<std::string> endless = {
      "--strategies", "bsdf,importance",     "--samples", "1,4,100000",
      "--progress",   "--reference-samples", "64"};
  std::vector<std::string> arguments = command(endless);
  std::erase(arguments, "--quiet");
  // The largest cells take minutes; smaller ones are done when the bar shows the first per cent.
  const CommandResult result = runExecutable(arguments, "% ");
  EXPECT_EQ(result.status, 130) << result.error;
  EXPECT_NE(result.error.find("the same command continues from there"), std::string::npos);
}

TEST_F(SlowCommandCompare, referenceFromAFileAndTimes) {
  const std::string reference = folder_ / "reference.exr";
  ASSERT_EQ(
      runCommand({"render", folder_ / "plate.gltf", "--probe", folder_ / "probe.exr", "--size",
                  "16x16", "--samples", "256", "-o", reference, "--aov", "variance", "--quiet"})
          .status,
      0);
  ASSERT_EQ(runCommand(command({"--strategies", "uniform", "--times", "0.1,0.2", "--repeats", "3",
                                "--reference", reference}))
                .status,
            0);
  const json all = results(), &cells = all["strategies"][0]["cells"];
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_EQ(cells[0]["budget"], "0.1s");
  EXPECT_GE(cells[0]["samples"], 1);
  for (const json& warning : all["warnings"])
    EXPECT_EQ(std::string(warning).find("assumed to be exact"), std::string::npos) << warning;
}

// A small sun that uniform samples rarely meet: their pair is not tested, and the reason is told.
TEST_F(SlowCommandCompare, rareBrightSamplesAreTold) {
  Image sun = constantProbe({64, 32}, Rgb(0.01f));
  sun.setRgb(1, 12, Rgb(3000));
  writeImage(folder_ / "probe.exr", sun);
  ASSERT_EQ(runCommand(command({"--strategies", "uniform,importance", "--samples", "4",
                                "--reference-samples", "256"}))
                .status,
            0);
  const json all = results();
  std::string told;
  for (const json& warning : all["warnings"]) told += std::string(warning);
  EXPECT_NE(told.find("most of the error of uniform:"), std::string::npos) << told;
  EXPECT_TRUE(all["agreement"].empty());
}

// A smaller sun, which no sample of BSDFs meets.
TEST_F(SlowCommandCompare, lightThatNoSampleHasFoundIsTold) {
  Image sun = constantProbe({2048, 1024}, Rgb(0.1f));
  sun.setRgb(33, 384, Rgb(1e5f));
  writeImage(folder_ / "probe.exr", sun);
  std::vector<std::string> arguments = command({"--strategies", "bsdf,importance", "--samples", "1",
                                                "--repeats", "3", "--reference-samples", "256"});
  std::erase(arguments, "--quiet");
  const CommandResult result = runCommand(arguments);
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.error.find("The samples of bsdf have not found light"), std::string::npos)
      << result.error;
  EXPECT_NE(result.out.find(" (light not found)\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\nUse importance.\n"), std::string::npos) << result.out;
  EXPECT_NE(fileContents(dir() + "/index.html").find("Light not found: an unbiased strategy"),
            std::string::npos);
}

TEST_F(SlowCommandCompare, badInputIsRejected) {
  const auto expectInputError = [&](const std::vector<std::string>& arguments, const char* reason) {
    expectError(command(arguments), reason);
  };
  expectInputError({"--strategies", "importanse"}, "importance");
  expectInputError({"--samples", "0"}, "--samples");
  expectInputError({"--times", "-1"}, "--times");
  expectInputError({"--repeats", "2"}, "--repeats");
  expectInputError({"--baseline", "uniform", "--strategies", "bsdf"}, "--baseline");
  expectInputError({"--reference-strategy", "median-cut"}, "biased");
  expectInputError({"--reference-strategy", "importance+regularize"}, "biased");
  expectInputError({"--strategies", "importance+blur"}, "is not a mode");
  expectInputError({"--strategies", "importance+"}, "is not a mode");
  expectInputError({"--strategies", "median-cut+guide"}, "guides renders with");
  expectInputError({"--strategies", "importance+irradiance-cache:0.1", "--shutter", "0.5"},
                   "open shutter");
  expectInputError({"--strategies", "importance+denoise", "--samples", "1,4"}, "at least 2");
  expectInputError({"--reference-samples", "3"}, "--reference-samples");
  Image sunny = constantProbe({32, 16}, Rgb(0.1f));
  sunny.setRgb(9, 4, Rgb(1e4f));
  writeImage(folder_ / "sunny.exr", sunny);
  std::vector<std::string> underSun = command({"--reference-strategy", "suns"});
  underSun[3] = folder_ / "sunny.exr";
  expectError(underSun, "biased");
  writeImage(folder_ / "other.exr", Image(8, 8, 3));
  expectInputError({"--reference", folder_ / "other.exr"}, "a size of 8x8");
  for (const char* strategy : {"nonsense", "importance", "auto"})
    expectInputError({"--reference", folder_ / "other.exr", "--reference-strategy", strategy},
                     "--reference-strategy: the reference is a file");
  expectInputError({"--reference-strategy", "nonsense"}, "unknown strategy `nonsense`");
  EXPECT_FALSE(fs::exists(dir())) << "created before the input was checked";

  ASSERT_EQ(runCommand(command(kSmall)).status, 0);
  expectInputError(with(kSmall, {"--seed", "1"}), "another folder");
  const fs::path stored = renders().begin()->first;
  const ImageFile file = readImageFile(stored);
  for (const char* other : {"bsdf-1spp-2.exr", "bsdf-4spp-1.exr", "importance-1spp-1.exr"}) {
    fs::copy_file(stored.parent_path() / other, stored, fs::copy_options::overwrite_existing);
    expectInputError(kSmall, "is damaged or was changed");
  }
  for (const Layer& spoilt : {Layer{"", "RGB", Image(8, 8, 3)}, Layer{"N", "XYZ", file.image}}) {
    writeImage(stored, OutputImage{{spoilt}, file.metadata});
    expectInputError(kSmall, "is damaged or was changed");
  }
  fs::resize_file(stored, fs::file_size(stored) / 2);
  expectInputError(kSmall, stored.filename().c_str());
}

// For every option in the command's help: either it does not change the renders, or renders with
// another value of it are not reused.
TEST_F(SlowCommandCompare, everyOptionThatChangesTheImageMakesAnotherComparison) {
  const std::set<std::string> irrelevant = {"help",
                                            "output",
                                            "strategies",
                                            "integrators",
                                            "samples",
                                            "times",
                                            "repeats",
                                            "baseline",
                                            "memory",
                                            "texture-memory",
                                            "progress",
                                            "quiet",
                                            "tonemap",
                                            "exposure",
                                            "allow-external",
                                            "reference",
                                            "reference-samples",
                                            "reference-strategy"};
  GltfWriter w;
  addTriangle(w, {}, {{"name", "thing"}});
  w.root["animations"] = {
      {{"name", "Still"}, {"channels", json::array()}, {"samplers", json::array()}}};
  w.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  for (const char* name : {"Near", "Far"})
    w.add("nodes", {{"name", name},
                    {"camera", 0},
                    {"translation", {0, 0, name == std::string("Near") ? 3 : 6}}});
  w.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
  w.root["scene"] = 0;
  w.root["extensions"] = {{"KHR_materials_variants", {{"variants", {{{"name", "Red"}}}}}}};
  writeImage(folder_ / "other.exr", gradientProbe({32, 16}, Rgb(0.5f), {0.6, 0.3, 0.6}));
  std::ofstream(folder_ / "camera.toml")
      << "[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nfov = 40\n";
  const std::map<std::string, Words> changes = {{"probe", {folder_ / "other.exr"}},
                                                {"probe-mapping", {"lat-long"}},
                                                {"probe-rotation", {"30"}},
                                                {"probe-scale", {"2"}},
                                                {"size", {"16x12"}},
                                                {"mis", {"power"}},
                                                {"max-depth", {"3"}},
                                                {"max-transmission-depth", {"3"}},
                                                {"max-diffuse-depth", {"3"}},
                                                {"max-specular-depth", {"3"}},
                                                {"single-sided", {"off"}},
                                                {"lights", {"2"}},
                                                {"sun-angle", {"2"}},
                                                {"light-from", {"rest"}},
                                                {"light-units", {"radiometric"}},
                                                {"camera", {"Far"}},
                                                {"camera-file", {folder_ / "camera.toml"}},
                                                {"view", {"30,20"}},
                                                {"look-at", {"thing"}},
                                                {"fov", {"30"}},
                                                {"zoom", {"2"}},
                                                {"ground", {}},
                                                {"drop", {}},
                                                {"animation", {"Still"}},
                                                {"animation-time", {"1"}},
                                                {"variant", {"Red"}},
                                                {"shutter", {"0.5"}},
                                                {"shutter-steps", {"4", "--shutter", "0.5"}},
                                                {"seed", {"7"}},
                                                {"threads", {"1"}}};
  const std::map<std::string, std::string> defaults = {
      {"probe", folder_ / "probe.exr"}, {"size", "16x16"}, {"threads", "2"}};
  const std::string model = w.save();
  const auto words = [&](const std::string& changed, const Words& to) {
    Words all{"compare", model,       "-o", dir(),       "--quiet", "--strategies",
              "bsdf",    "--samples", "1",  "--repeats", "3",       "--reference-samples",
              "8"};
    for (const auto& [name, value] : defaults)
      if (name != changed) all.insert(all.end(), {"--" + name, value});
    if (!changed.empty()) all.push_back("--" + changed);
    all.insert(all.end(), to.begin(), to.end());
    return all;
  };
  ASSERT_EQ(runCommand(words("", {})).status, 0);

  const std::string help = runCommand({"compare", "--help", "all"}).out;
  for (const Captures& option : allMatches(help, "--([a-z-]+)")) {
    const std::string name = option[1];
    if (irrelevant.contains(name)) continue;
    const auto change = changes.find(name);
    if (change == changes.end()) {
      ADD_FAILURE() << "--" << name << ": add it to `irrelevant` or `changes`";
      continue;
    }
    const CommandResult result = runCommand(words(name, change->second));
    EXPECT_EQ(result.status, 2) << name;
    EXPECT_NE(result.error.find("another comparison"), std::string::npos) << name << result.error;
  }
  EXPECT_EQ(runCommand(words("", {})).status, 0) << "the original command no longer matches";

  // A file that the model refers to changes the comparison too.
  w.write("data.bin", std::vector<uint8_t>(36));
  expectError(words("", {}), "contents of data.bin");
}

// A mode is a row of its own, biased or not.
TEST_F(SlowCommandCompare, comparesModes) {
  const std::string all[] = {"importance", "importance+adaptive+guide", "importance+regularize",
                             "importance+glass-shadows", "importance+denoise"};
  const CommandResult result =
      runCommand(command({"--strategies",
                          "importance,importance+guide+adaptive,importance+regularize,"
                          "importance+glass-shadows,importance+denoise",
                          "--samples", "8", "--repeats", "3", "--reference-samples", "64"}));
  ASSERT_EQ(result.status, 0) << result.error;
  const json found = results();
  std::set<std::string> names, biased;
  for (const json& row : found["strategies"]) {
    names.insert(row["name"]);
    if (!row["unbiased"]) biased.insert(row["name"]);
  }
  EXPECT_EQ(names, std::set<std::string>(std::begin(all), std::end(all)));
  EXPECT_EQ(biased, std::set<std::string>(std::begin(all) + 2, std::end(all)));
}

// What `render` says of an idle setting, `compare` says of a row's mode.
TEST_F(SlowCommandCompare, idleModesAreNamed) {
  const TemporaryFolder out;
  const std::string root = kSourceDir;
  const auto errorOf = [&](const std::string& row, const char* samples) {
    const CommandResult result = runCommand(
        {"compare", root + "/scenes/models/pillars.gltf", "--probe", root + "/probes/dusk.exr",
         "--size", "12x8", "--strategies", row, "--samples", samples, "--repeats", "3",
         "--reference-samples", "16", "-o", out / ("of-" + row)});
    EXPECT_EQ(result.status, 0) << result.error;
    return result.error;
  };
  const auto expectIdle = [&](const std::string& row, const char* line, const char* samples) {
    const std::string error = errorOf(row, samples);
    EXPECT_NE(error.find(row + ": " + line), std::string::npos) << error;
  };
  expectIdle("importance+glass-shadows", "`render.glass_shadows` has no effect without", "16");
  expectIdle("importance+guide+diffuse-depth:2", "nothing is guided, since", "16");
  expectIdle("importance+diffuse-depth:9", "`render.max_diffuse_depth` has no effect", "16");
  expectIdle("importance+specular-depth:9", "`render.max_specular_depth` has no effect", "16");
  expectIdle("importance+guide", "nothing is guided with fewer than", "4");
  const std::string error = errorOf("importance+guide+regularize", "16");
  EXPECT_EQ(error.find("no effect"), std::string::npos) << error;
  EXPECT_EQ(error.find("nothing is guided"), std::string::npos) << error;
}

TEST_F(SlowCommandCompare, storedResultsStayInTheReport) {
  const Words first = {"--strategies",        "bsdf,uniform",
                       "--samples",           "1,4",
                       "--repeats",           "3",
                       "--reference-samples", "64"};
  ASSERT_EQ(runCommand(command(first)).status, 0);
  const json before = results();
  ASSERT_EQ(runCommand(command({"--strategies", "bsdf", "--samples", "2", "--repeats", "3",
                                "--reference-samples", "64"}))
                .status,
            0);
  const json after = results();
  ASSERT_EQ(after["strategies"].size(), 2u);
  EXPECT_EQ(after["strategies"][0]["cells"].size(), 3u);
  EXPECT_EQ(after["strategies"][1]["cells"], before["strategies"][1]["cells"]);
  EXPECT_TRUE(after["complete"]);
}

TEST_F(SlowCommandCompare, almostEqualBudgetsAreDistinct) {
  ASSERT_EQ(runCommand(command({"--strategies", "bsdf", "--times", "0.05,0.0500000001", "--repeats",
                                "3", "--reference-samples", "8"}))
                .status,
            0);
  EXPECT_EQ(results()["strategies"][0]["cells"].size(), 2u);
  EXPECT_EQ(renders().size(), 8u + 2 * 3);
}

TEST_F(SlowCommandCompare, summarisesTheResultInWords) {
  Words arguments = command(kSmall);
  std::erase(arguments, "--quiet");
  const CommandResult result = runCommand(arguments);
  ASSERT_EQ(result.status, 0);
  EXPECT_NE(result.out.find("\nUse "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\nOf 1 biased, "), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find(" (biased) "), result.out.rfind(" (biased) ")) << result.out;
  EXPECT_NE(result.out.find(" (biased) "), std::string::npos) << result.out;
  const std::string report = "\nReport: " + dir() + "/index.html, exposure ";
  const size_t at = result.out.find(report);
  ASSERT_NE(at, std::string::npos) << result.out;
  EXPECT_NE(result.out.find(" stops (auto, of the reference)\n", at), std::string::npos);
  const std::string page = fileContents(dir() + "/index.html");
  const float stops = std::stof(result.out.substr(at + report.size()));
  EXPECT_NE(page.find(fmt::format("value=\"{:g}\"", stops)), std::string::npos) << stops;
  EXPECT_LT(page.find("<li>Use "), page.find("How fast the error falls"));
}

TEST_F(SlowCommandCompare, numbersAreRoundedToTheirErrors) {
  Words arguments = command(kSmall);
  std::erase(arguments, "--quiet");
  const std::string table = runCommand(arguments).out;
  int found = 0;
  for (const Captures& match :
       allMatches(table, "([0-9.]+)(e[-+0-9]+)? \\+- ([0-9.]+)(e[-+0-9]+)?")) {
    ++found;
    const auto decimals = [](const std::string& text) {
      const size_t point = text.find('.');
      return point == std::string::npos ? 0 : int(text.size() - point) - 1;
    };
    EXPECT_EQ(decimals(match[1]), decimals(match[3])) << match[0];
    EXPECT_EQ(match[2], match[4]) << match[0];
    std::string digits = match[3];
    std::erase(digits, '.');
    digits.erase(0, digits.find_first_not_of('0'));
    while (digits.ends_with('0') && digits.size() > 1) digits.pop_back();
    EXPECT_LE(digits.size(), digits.starts_with('1') ? 2u : 1u) << match[0];
  }
  EXPECT_GT(found, 4) << table;
}

TEST_F(SlowCommandCompare, warnsThatItIgnoresThePlate) {
  std::ofstream(folder_ / "scene.toml")
      << "model = 'plate.gltf'\n[probe]\nfile = 'probe.exr'\n[composite]\nplate = 'probe.exr'\n"
         "local_scene = ['0']\n";
  const CommandResult result =
      runCommand({"compare", folder_ / "scene.toml", "--size", "8x8", "-o", dir(), "--quiet",
                  "--strategies", "bsdf", "--samples", "1", "--reference-samples", "8"});
  ASSERT_EQ(result.status, 0) << result.error;
  EXPECT_NE(result.error.find("[composite] is ignored"), std::string::npos) << result.error;
}

TEST_F(SlowCommandCompare, HasNoPlateToScaleTheProbeBy) {
  std::ofstream(folder_ / "scene.toml")
      << "model = 'plate.gltf'\n[probe]\nfile = 'probe.exr'\nscale = 'plate'\n[composite]\n"
         "plate = 'probe.exr'\nground = true\n";
  expectError({"compare", folder_ / "scene.toml", "-o", dir()},
              "scene.toml:4: scale = \"plate\" is of the [composite], which is ignored here");
}

}  // namespace
}  // namespace chromeball::command_compare_test
