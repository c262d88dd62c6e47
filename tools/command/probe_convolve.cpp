// SPDX-License-Identifier: Apache-2.0
// chromeball probe convolve IN OUT --kernel KERNEL
#include <optional>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "commands.h"
#include "front/arguments.h"
#include "image/io/output_file.h"
#include "image/io/write_image.h"
#include "image_files.h"
#include "messages.h"
#include "probe/convert.h"
#include "probe/convolve.h"
#include "probe/irradiance.h"
#include "probe/load.h"
#include "probe/prefiltered_probe.h"
#include "probe_options.h"
#include "progress_bar.h"

namespace chromeball {
namespace {

struct ProbeConvolveArguments {
  std::string in, out, kernel, size, fromSize, method = "exact", mips, mapping = "auto";
  Rotation rotation;
};

// The kernel with a parameter, in the form NAME:NUMBER.
ZonalKernel parseKernel(const std::string& text) {
  const size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  if (text == "diffuse") return ZonalKernel::phong(1);
  if (name != "phong" && name != "ggx")
    throwInput("--kernel: unknown kernel `{}`; {}", name,
               didYouMean(name, {"diffuse", "phong", "ggx"}));
  if (colon == std::string::npos)
    throwInput("--kernel: {} needs {}", text,
               text == "ggx" ? "a roughness, ggx:0.3" : "an exponent, phong:20");
  const double number = parseNumbers(text.substr(colon + 1), 1, "--kernel")[0];
  return name == "phong" ? ZonalKernel::phong(number) : ZonalKernel::ggx(number);
}

bool isKtx(const ProbeConvolveArguments& arguments) { return arguments.out.ends_with(".ktx2"); }

void check(const ProbeConvolveArguments& arguments) {
  if (isKtx(arguments)) {
    checkReplaceable(arguments.out);
    if (!arguments.kernel.empty() || arguments.method != "exact")
      throwInput("--kernel, --method: a .ktx2 has a level for each of several roughnesses of GGX");
  } else {
    checkWritable(arguments.out);
    if (!arguments.mips.empty()) throwInput("--mips: only a .ktx2 has levels");
    if (arguments.kernel.empty()) throwInput("--kernel: give diffuse, phong:N or ggx:ROUGHNESS");
  }
  checkDistinct({arguments.out}, {arguments.in});
  if (arguments.method != "exact" && arguments.method != "sh")
    throwInput("--method: unknown method `{}`; {}", arguments.method,
               didYouMean(arguments.method, {"exact", "sh"}));
}

Image convolvedMap(const ProbeConvolveArguments& arguments, const Image& latLong,
                   const ZonalKernel& kernel, const ImageSize& size) {
  const std::vector<vec3> directions = texelDirections(size, arguments.rotation);
  return imageOf(size, arguments.method == "exact" ? convolve(latLong, kernel, directions)
                                                   : shConvolve(latLong, kernel, directions));
}

// Each texel is the mean over its solid angle.
Image reduced(const ProbeConvolveArguments& arguments, const Image& latLong) {
  const ImageSize size = parseSize(arguments.fromSize, "--from-size");
  if (size.width > latLong.width || size.height > latLong.height)
    throwInput("--from-size: {} is larger than the map, {}x{}", arguments.fromSize, latLong.width,
               latLong.height);
  return convert(latLong, Mapping::LatLong, Mapping::LatLong, size);
}

void writeLevels(const ProbeConvolveArguments& arguments, const Image& latLong) {
  const ImageSize face = parseSize(arguments.size.empty() ? "256x256" : arguments.size, "--size");
  if (face.width != face.height) throwInput("--size: a face of a cube is square");
  checkedSize(arguments.out, {6 * face.width, face.height});
  const std::string mips = arguments.mips.empty() ? "khronos" : arguments.mips;
  const MipRoughness roughness = parseMipRoughness(mips, "--mips");
  std::optional<BusyLine> busy("prefiltering the levels");
  const Image turned = convert(latLong, Mapping::LatLong, Mapping::LatLong,
                               {latLong.width, latLong.height}, arguments.rotation);
  const std::vector<CubeLevel> levels = cubeMips(turned, face.width, roughness);
  std::vector<const Image*> images;
  for (const CubeLevel& level : levels) images.push_back(&level.faces);
  const size_t clipped = writeKtx2(arguments.out, images);
  busy.reset();
  for (const CubeLevel& level : levels)
    say("{0}x{0}: roughness {1:.4g}\n", level.faces.width, level.roughness);
  if (clipped)
    warn("{}: {} channels exceed a half float and are clipped at 65504", arguments.out, clipped);
}

void run(const ProbeConvolveArguments& arguments) {
  check(arguments);
  std::optional<ZonalKernel> kernel;
  if (!isKtx(arguments)) kernel = parseKernel(arguments.kernel);
  LoadedProbe probe = openProbe(arguments.in, arguments.mapping, "--probe-mapping");
  if (!arguments.fromSize.empty()) probe.latLong = reduced(arguments, probe.latLong);
  if (!kernel) {
    writeLevels(arguments, probe.latLong);
    return;
  }
  const ImageSize size =
      checkedSize(arguments.out,
                  arguments.size.empty() ? ImageSize{probe.latLong.width, probe.latLong.height}
                                         : parseSize(arguments.size, "--size"),
                  kernel->isCosine() ? kIrradianceCopies : 4);
  std::optional<BusyLine> busy("convolving the probe");
  const Image map = convolvedMap(arguments, probe.latLong, *kernel, size);
  busy.reset();
  writeProbe(arguments.out, map);
}

}  // namespace

void addProbeConvolveCommand(Command probe) {
  auto [command, a] = probe.addCommand<ProbeConvolveArguments>(
      "convolve", "Blur a probe by the lobe of a surface: a prefiltered environment map.", run);
  command.addRequired("IN", a.in, "the probe's image");
  command.addRequired("OUT", a.out,
                      "the lat-long map to write: .exr, .hdr, .pfm or .png; or a cube map with "
                      "levels for the roughnesses of GGX: .ktx2");
  command.addOption("--kernel", a.kernel,
                    "diffuse (irradiance / pi), phong:EXPONENT or ggx:ROUGHNESS");
  command.addOption("--size", a.size,
                    "WIDTHxHEIGHT; else the probe's, as lat-long. Of a face of a .ktx2: 256x256");
  command.addOption("--from-size", a.fromSize,
                    "reduce the probe to WIDTHxHEIGHT first: faster, and less exact");
  command.addWithDefault("--method", a.method,
                         "exact, or sh: spherical harmonics to order 2, may be negative");
  command.addOption("--mips", a.mips,
                    "the roughness of the levels of a .ktx2: khronos (linear), or filament");
  addRotationOption(command, a.rotation);
  command.addOption("--probe-mapping", a.mapping, "the mapping of IN; auto detects it");
}

}  // namespace chromeball
