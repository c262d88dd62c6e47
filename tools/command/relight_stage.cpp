// SPDX-License-Identifier: Apache-2.0
#include "relight.h"

#include <filesystem>

#include "base/error.h"
#include "base/progress.h"
#include "base/text.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "probe/load.h"
#include "relight/stage/light_stage.h"
#include "relight/stage/relit_stage.h"
#include "session/memory_estimate.h"
#include "viewers/relight_server.h"

namespace chromeball {
namespace {

// "10%", as a fraction above 0 and up to 1.
double parseShare(std::string text, const char* option) {
  const std::string given = text;
  if (text.ends_with('%')) text.pop_back();
  const double percent = parseNumbers(text, 1, option)[0];
  if (!(percent > 0 && percent <= 100))
    throwInput("{}: `{}` should be above 0% and up to 100%", option, given);
  return percent / 100;
}

// The memory left for a stage beside the program, in bytes.
double memoryOf(const RelightOptions& a) {
  if (a.memory && !(*a.memory > 0 && std::isfinite(*a.memory)))
    throw InputError("--memory: must be a positive number of GB");
  constexpr double kLight = 3e7;  // the weights' sums, and a probe of usual size
  return (a.memory ? 1e9 * *a.memory : memoryBudget()) - kProcessBytes - kLight;
}

LightStage readPhotographsOf(const RelightOptions& a) {
  const double irradiance = parseNumbers(a.irradiance, 1, "--irradiance")[0];
  if (!isPositiveFloat(irradiance)) throwInput("--irradiance: should be {}", kPositiveFloats);
  const std::vector<StagePhotograph> photographs = readPhotographs(a.directions);
  std::vector<std::string> inputs;
  for (const StagePhotograph& photograph : photographs)
    inputs.push_back((std::filesystem::path(a.images) / photograph.file).string());
  if (!a.out.empty()) checkDistinct({a.out}, inputs);
  Messages messages;
  LightStage stage = stageOf(a.images, photographs, float(irradiance), memoryOf(a), messages);
  print(messages);
  return stage;
}

StageBands openStage(const RelightOptions& a) {
  if (a.isOfPhotographs()) return StageBands(readPhotographsOf(a));
  StageReader file(a.stage);
  print(file.messages());
  const double rest = relitStageBytes(file.width(), file.height());
  return {std::move(file), memoryOf(a) - rest, a.stage};
}

// Reads the stage all at once, as --preview needs it.
LightStage readStage(const RelightOptions& a) {
  if (a.isOfPhotographs()) return readPhotographsOf(a);
  StageReader file(a.stage);
  print(file.messages());
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

Image loadLight(const RelightOptions& a, const std::string& path) {
  const LoadedProbe loaded = openProbe(path, a.mapping, "--probe-mapping");
  return Probe(loaded.latLong, {}, parseColor(a.scale, "--probe-scale")).latLong();
}

void checkPictureFinite(const Image& picture, const std::string& path) {
  for (const float texel : picture.texels)
    if (!std::isfinite(texel))
      throwInput("{}: the picture exceeds the largest float, 3.4e38; give a smaller --probe-scale",
                 path);
}

void writePicture(const RelightOptions& a, const Image& picture, const DirectionBasis& basis,
                  const Metadata& more = {}) {
  const DisplayTransform transform{parseToneOperator(a.tone), a.exposure};
  OutputImage output;
  output.layers.push_back({"", "RGB", picture});
  output.metadata = {{"Software", std::string("chromeball " CHROMEBALL_VERSION)},
                     {"stage", a.source()},
                     {"basis", basis.name()}};
  if (!a.probes.empty()) output.metadata["probe"] = a.probes.front();
  output.metadata.insert(more.begin(), more.end());
  writeKept(a.out, std::move(output), a.source(), transform);
}

// "": all was kept.
std::string leftOutInWords(const RelitStage& relit, const KeptShares& kept) {
  if (kept.isAll()) return "";
  return fmt::format(": {:.2f}% of the stage and {:.2f}% of the light are zeros, error {:.3g}%",
                     100 * relit.zeros, 100 * relit.lightZeros, 100 * relit.error);
}

uint64_t parsePort(const std::string& text) {
  const double port = parseNumbers(text, 1, "--preview")[0];
  if (!(port >= 0 && port <= 65535 && port == std::floor(port)))
    throwInput("--preview: `{}` is not a port, 0 to 65535", text);
  return uint64_t(port);
}

}  // namespace

void runRelitPicture(const RelightOptions& a) {
  const Stopwatch watch;
  const KeptShares kept{parseShare(a.keep, "--keep"), parseShare(a.keepLight, "--keep-light")};
  Image light = loadLight(a, a.probes.front());
  StageBands stage = openStage(a);
  const RelightDomain domain = parseDomain(a.domain, stage.basis());
  const std::vector<Rgb> weights = lightWeights(stage.basis(), light, a.rotation);
  light = {};
  const RelitStage relit = relitStage(stage, weights, domain, kept);
  checkPictureFinite(relit.picture, a.source());
  writePicture(a, relit.picture, stage.basis());
  say("relit {} x {} pixels from {} elements ({}) in {:.2f} s{}: {}\n", stage.width(),
      stage.height(), stage.basis().size(), stage.basis().name(), watch.seconds(),
      leftOutInWords(relit, kept), printableName(a.out));
}

void runReflectanceFunction(const RelightOptions& a) {
  StageBands stage = openStage(a);
  const glm::ivec2 pixel = parsePixel(a.pixel, stage);
  const Image map = reflectanceFunction(stage.row(pixel.y), pixel.x, 0);
  writePicture(a, map, stage.basis(), {{kMappingAttribute, mappingName(Mapping::LatLong)}});
  say("reflectance function of pixel {}, {} ({}), {} x {} directions: {}\n", pixel.x, pixel.y,
      stage.basis().name(), map.width, map.height, printableName(a.out));
}

void runRelightPreview(const RelightOptions& a) {
  const uint64_t port = parsePort(a.preview);
  std::vector<NamedProbe> probes;
  for (const std::string& path : a.probes)
    probes.push_back({std::filesystem::path(path).filename().string(), loadLight(a, path)});
  serveRelight(int(port), readStage(a), std::move(probes));
}

}  // namespace chromeball
