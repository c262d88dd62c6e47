// SPDX-License-Identifier: Apache-2.0
// chromeball relight STAGE.exr --probe P -o OUT.exr: a light stage under a probe.
// chromeball relight STAGE.exr --probe P --probe Q --preview: on a page, where the probes turn.
// chromeball relight MODEL_PRT.glb --probe P -o MODEL_LIT.glb: vertices by their transfer.
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "base/stopwatch.h"
#include "commands.h"
#include "image/io/write_image.h"
#include "job/arguments.h"
#include "job/image_memory.h"
#include "job/output_file.h"
#include "messages.h"
#include "probe/load.h"
#include "relight/light_weights.h"
#include "relight/reflectance_function.h"
#include "relight/relit_stage.h"
#include "relight/stage_photographs.h"
#include "relight_model.h"
#include "rotation_option.h"
#include "viewers/relight_server.h"

namespace chromeball {
namespace {

struct Arguments {
  std::string stage;               // or:
  std::string images, directions;  // photographs
  std::string irradiance = "1";    // of these
  std::vector<std::string> probes;
  std::string mapping = "auto", scale = "1";
  Rotation rotation;
  std::string domain = "auto", keep = "100%", keepLight = "100%";
  std::string pixel;  // of the reflectance function
  std::string out, tone = "none";
  float exposure = 0;
  std::optional<double> white;  // of a model
  std::string view;             // of a model with glossy transfer
  bool allowsExternal = false, quiet = false;
  std::string preview;           // the port; empty: none
  std::optional<double> memory;  // GB

  bool isOfPhotographs() const { return !images.empty() || !directions.empty(); }
  bool isOfModel() const {
    const std::string extension = lowerExtension(stage);
    return extension == ".glb" || extension == ".gltf";
  }
  const std::string& source() const { return isOfPhotographs() ? images : stage; }
};

// "10%", as a fraction above 0 and up to 1.
double parseShare(std::string text, const char* option) {
  const std::string given = text;
  if (text.ends_with('%')) text.pop_back();
  const double percent = parseNumbers(text, 1, option)[0];
  if (!(percent > 0 && percent <= 100))
    throwInput("{}: `{}` should be above 0% and up to 100%", option, given);
  return percent / 100;
}

// What is left for a stage beside the program, in bytes.
double memoryOf(const Arguments& a) {
  if (a.memory && !(*a.memory > 0 && std::isfinite(*a.memory)))
    throw InputError("--memory: must be a positive number of GB");
  constexpr double kLight = 3e7;  // the weights' sums, and a probe of usual size
  return (a.memory ? 1e9 * *a.memory : memoryBudget()) - kProcessBytes - kLight;
}

LightStage readPhotographsOf(const Arguments& a) {
  const double irradiance = parseNumbers(a.irradiance, 1, "--irradiance")[0];
  if (!isPositiveFloat(irradiance)) throwInput("--irradiance: should be {}", kPositiveFloats);
  const std::vector<StagePhotograph> photographs = readPhotographs(a.directions);
  std::vector<std::string> inputs;
  for (const StagePhotograph& photograph : photographs)
    inputs.push_back((std::filesystem::path(a.images) / photograph.file).string());
  if (!a.out.empty()) checkDistinct({a.out}, inputs);
  return stageOf(a.images, photographs, float(irradiance), memoryOf(a));
}

StageBands openStage(const Arguments& a) {
  if (a.isOfPhotographs()) return StageBands(readPhotographsOf(a));
  StageReader file(a.stage);
  const double rest = relitStageBytes(file.width(), file.height());
  return {std::move(file), memoryOf(a) - rest, a.stage};
}

// At once, as --preview needs it.
LightStage readStage(const Arguments& a) {
  if (a.isOfPhotographs()) return readPhotographsOf(a);
  StageReader file(a.stage);
  checkInMemory(file.basis(), file.width(), file.height(), memoryOf(a) - file.bufferBytes(),
                "--preview");
  return file.read(0, file.height());
}

glm::ivec2 parsePixel(const std::string& text, const StageBands& stage) {
  constexpr const char* kOption = "--reflectance-function";
  const std::vector<double> at = parseNumbers(text, 2, kOption);
  const auto isIn = [](double number, int count) {
    return number >= 0 && number < count && number == std::floor(number);
  };
  if (!isIn(at[0], stage.width()) || !isIn(at[1], stage.height()))
    throwInput("{}: pixel `{}` is not in the {} x {} pixels of the stage", kOption, text,
               stage.width(), stage.height());
  return {int(at[0]), int(at[1])};
}

Image loadLight(const Arguments& a, const std::string& path) {
  const LoadedProbe loaded = loadProbe(path, a.mapping, "--mapping");
  for (const std::string& warning : warnings(loaded, path)) warn(warning);
  return Probe(loaded.latLong, {}, parseColor(a.scale, "--scale")).latLong();
}

void checkFinite(const Image& picture, const std::string& path) {
  for (const float texel : picture.texels)
    if (!std::isfinite(texel))
      throwInput("{}: the picture exceeds the largest float, 3.4e38; give a smaller --scale", path);
}

void writePicture(const Arguments& a, const Image& picture, const DirectionBasis& basis) {
  const DisplayTransform transform{parseToneOperator(a.tone), a.exposure};
  OutputImage output;
  output.layers.push_back({"", "RGB", picture});
  output.metadata = {{"Software", std::string("chromeball " CHROMEBALL_VERSION)},
                     {"stage", a.source()},
                     {"basis", basis.name()}};
  if (!a.probes.empty()) output.metadata["probe"] = a.probes.front();
  writeImage(a.out, output, transform);
}

// "": all was kept.
std::string leftOutInWords(const RelitStage& relit, const KeptShares& kept) {
  if (kept.isAll()) return "";
  return fmt::format(": {:.2f}% of the stage and {:.2f}% of the light are zeros, error {:.3g}%",
                     100 * relit.zeros, 100 * relit.lightZeros, 100 * relit.error);
}

void runPicture(const Arguments& a) {
  const Stopwatch watch;
  const KeptShares kept{parseShare(a.keep, "--keep"), parseShare(a.keepLight, "--keep-light")};
  Image light = loadLight(a, a.probes.front());
  StageBands stage = openStage(a);
  const RelightDomain domain = parseDomain(a.domain, stage.basis());
  const std::vector<Rgb> weights = lightWeights(stage.basis(), light, a.rotation);
  light = {};
  const RelitStage relit = relitStage(stage, weights, domain, kept);
  checkFinite(relit.picture, a.source());
  writePicture(a, relit.picture, stage.basis());
  if (!a.quiet)
    fmt::print("relit {} x {} pixels from {} elements ({}) in {:.2f} s{}: {}\n", stage.width(),
               stage.height(), stage.basis().size(), stage.basis().name(), watch.seconds(),
               leftOutInWords(relit, kept), a.out);
}

void runReflectanceFunction(const Arguments& a) {
  StageBands stage = openStage(a);
  const glm::ivec2 pixel = parsePixel(a.pixel, stage);
  const Image map = reflectanceFunction(stage.row(pixel.y), pixel.x, 0);
  writePicture(a, map, stage.basis());
  if (!a.quiet)
    fmt::print("reflectance function of pixel {}, {} ({}), {} x {} directions: {}\n", pixel.x,
               pixel.y, stage.basis().name(), map.width, map.height, a.out);
}

uint64_t parsePort(const std::string& text) {
  const double port = parseNumbers(text, 1, "--preview")[0];
  if (!(port >= 0 && port <= 65535 && port == std::floor(port)))
    throwInput("--preview: `{}` is not a port, 0 to 65535", text);
  return uint64_t(port);
}

void runPreview(const Arguments& a) {
  const uint64_t port = parsePort(a.preview);
  std::vector<NamedProbe> probes;
  for (const std::string& path : a.probes)
    probes.push_back({std::filesystem::path(path).filename().string(), loadLight(a, path)});
  const RelightView view(readStage(a), std::move(probes));
  RelightServer server(int(port), view);
  note(fmt::format("preview at {}; Ctrl-C or its button ends it", server.address()));
  server.run();
}

// Options that are given, or other than by default.
using GivenOptions = std::vector<std::pair<bool, const char*>>;

void refuse(const GivenOptions& options, const char* why) {
  for (const auto& [given, option] : options)
    if (given) throwInput("{}: {}", option, why);
}

GivenOptions optionsOfSum(const Arguments& a) {
  return {{a.domain != "auto", "--domain"},
          {a.keep != "100%", "--keep"},
          {a.keepLight != "100%", "--keep-light"},
          {a.rotation != Rotation(), "--rotation"}};
}

GivenOptions optionsOfDisplay(const Arguments& a) {
  return {{a.exposure != 0, "--exposure"}, {a.tone != "none", "--tonemap"}};
}

void checkOutput(const Arguments& a) {
  if (lowerExtension(a.out) != ".png")
    refuse(optionsOfDisplay(a), "is for a .png; other images are linear");
  if (!a.pixel.empty()) {
    constexpr const char* kWhy = "has no effect with --reflectance-function; leave it out";
    refuse(optionsOfSum(a), kWhy);
    refuse({{a.scale != "1", "--scale"}, {a.mapping != "auto", "--mapping"}}, kWhy);
  }
  if (a.probes.size() > 1) throwInput("--probe: give one; --preview takes several");
  if (a.out.empty()) throwInput("--output: needs a name; or give --preview");
  checkWritable(a.out);
  std::vector<std::string> inputs{a.stage, a.directions};
  inputs.insert(inputs.end(), a.probes.begin(), a.probes.end());
  checkDistinct({a.out}, inputs);
}

void checkPreview(const Arguments& a) {
  constexpr const char* kWhy = "has no effect with --preview; leave it out";
  refuse({{!a.out.empty(), "--output"}, {!a.pixel.empty(), "--reflectance-function"}}, kWhy);
  refuse(optionsOfSum(a), kWhy);
  refuse(optionsOfDisplay(a), kWhy);
}

void runModel(const Arguments& a) {
  constexpr const char* kWhy = "has no effect on a model; leave it out";
  refuse({{!a.preview.empty(), "--preview"},
          {a.isOfPhotographs(), "--images"},
          {a.irradiance != "1", "--irradiance"},
          {!a.pixel.empty(), "--reflectance-function"},
          {a.memory.has_value(), "--memory"},
          {a.domain != "auto", "--domain"},
          {a.keepLight != "100%", "--keep-light"}},
         kWhy);
  refuse(optionsOfDisplay(a), kWhy);
  if (a.probes.size() != 1) throwInput("--probe: give one");
  if (a.out.empty()) throwInput("--output: needs a name");
  runRelightModel({a.stage, a.out, a.probes.front(), a.mapping, a.scale, a.keep, a.rotation, a.view,
                   a.white, a.allowsExternal, a.quiet});
}

void check(const Arguments& a) {
  refuse({{a.white.has_value(), "--white"},
          {!a.view.empty(), "--view"},
          {a.allowsExternal, "--allow-external"}},
         "needs a model with transfer, .glb or .gltf");
  if (!a.isOfPhotographs()) refuse({{a.irradiance != "1", "--irradiance"}}, "is for --images");
  if (a.isOfPhotographs() != a.stage.empty())
    throwInput("{}", a.stage.empty()
                         ? "STAGE: give a light stage, or photographs by --images and --directions"
                         : "--images, --directions: are in place of a light stage; give one");
  if (a.isOfPhotographs() && (a.images.empty() || a.directions.empty()))
    throwInput("--images, --directions: go together");
  if (a.probes.empty() == a.pixel.empty())
    throwInput("--probe, --reflectance-function: give one of the two");
  parseColor(a.scale, "--scale");
  parseToneOperator(a.tone);
  if (!std::isfinite(a.exposure)) throwInput("--exposure: must be a finite number of stops");
  a.preview.empty() ? checkOutput(a) : checkPreview(a);
}

void run(const Arguments& a) {
  if (a.isOfModel()) return runModel(a);
  check(a);
  if (!a.preview.empty()) return runPreview(a);
  a.pixel.empty() ? runPicture(a) : runReflectanceFunction(a);
}

}  // namespace

void addRelightCommand(CLI::App& app) {
  const auto a = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("relight", "Light a light stage, or a model with transfer, by a probe");
  command->add_option("STAGE", a->stage, "the light stage or model, from `chromeball basis`");
  command->add_option("--images", a->images,
                      "in place of STAGE: a folder of linear photographs of a subject, each under "
                      "light from one direction");
  command->add_option(
      "--directions", a->directions,
      "a .csv of these: FILE,X,Y,Z or FILE,AZIMUTH,ELEVATION (degrees) on each line");
  command
      ->add_option("--irradiance", a->irradiance,
                   "of these: what the lamp puts on a surface that faces it")
      ->capture_default_str();
  command->add_option("--probe", a->probes, "the light; with --preview several, each by --probe")
      ->type_name("TEXT")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--mapping", a->mapping, "of the probe; auto detects it")
      ->capture_default_str();
  addRotationOption(*command, a->rotation);
  command->add_option("--scale", a->scale, "X or R,G,B: factor of the probe")
      ->capture_default_str();
  command
      ->add_option("--domain", a->domain,
                   "where the sum is made: pixel, dct (lat-long), haar (cube), sh; the result is "
                   "the same, unless some is left out")
      ->capture_default_str();
  command
      ->add_option("--keep", a->keep,
                   "PERCENT of the stage's numbers in that domain to keep, the largest; prints the "
                   "error. Of a model: how many of the light's coefficients to keep, or PERCENT%")
      ->capture_default_str();
  command
      ->add_option("--keep-light", a->keepLight,
                   "PERCENT of the light's numbers in that domain to keep, the largest")
      ->capture_default_str();
  command->add_option("--reflectance-function", a->pixel,
                      "X,Y: in place of a probe, what this pixel reflects of light from each "
                      "direction, as a lat-long map");
  command->add_option("-o,--output", a->out,
                      "the image to write: .exr, .hdr, .pfm or .png; of a model .glb or .gltf");
  command->add_flag("--preview")
      ->description(
          "in place of an output: a page at http://127.0.0.1:PORT/ (any free port without one) on "
          "which the probes are turned and swapped")
      ->each([a](const std::string& word) { a->preview = word == "true" ? "0" : word; })
      ->type_name("[=PORT]");
  command->add_option("--white", a->white,
                      "of a model: the light that its white stands for; without it, the brightest");
  command->add_option("--view", a->view, "X,Y,Z: the eye, of a model with glossy transfer");
  command->add_flag("--allow-external", a->allowsExternal,
                    "of a model: read files outside of its folder");
  command->add_option("--memory", a->memory,
                      "GB: a stage that takes more is read in bands; else 0.8 times the machine's");
  command->add_option("--exposure", a->exposure, "of a .png, in stops");
  command
      ->add_option("--tonemap", a->tone,
                   fmt::format("of a .png: {}", fmt::join(toneOperatorNames(), ", ")))
      ->capture_default_str();
  command->add_flag("--quiet", a->quiet, "print nothing but warnings and errors");
  command->callback([a] { run(*a); });
}

}  // namespace chromeball
