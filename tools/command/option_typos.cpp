// SPDX-License-Identifier: Apache-2.0
#include "option_typos.h"

#include <algorithm>
#include <array>
#include <string>

namespace chromeball {
namespace {

struct Equivalents {
  std::string_view option;
  std::string_view names;  // of other renderers, each between spaces
};

// Options of Blender, Cycles, Mitsuba, pbrt, LuxCore, Arnold, appleseed and image tools.
constexpr auto kEquivalents = std::to_array<Equivalents>({
    {"--samples N",
     " spp s sample-count num-samples nsamples samples-per-pixel pixel-samples pixelsamples "
     "aa-samples sample iterations passes "},
    {"--output FILE", " outfile output-file out render-output save filename file image dest "},
    {"--size WxH",
     " width height w resolution res dimensions image-size x y resolution-x resolution-y "
     "film-size "},
    {"--probe FILE",
     " envmap env env-map environment environment-map hdri hdr ibl sky skydome background world "
     "light infinite-light environment-image "},
    {"--probe-rotation YAW[,PITCH,ROLL]",
     " rotation rotate env-rotation envmap-rotation hdri-rotation environment-rotation yaw "},
    {"--probe-scale R[,G,B]",
     " env-strength env-intensity envmap-scale hdri-strength intensity strength "
     "environment-intensity brightness scale "},
    {"--max-depth N",
     " bounces max-bounces depth maxdepth path-depth max-path-length path-length ray-depth "
     "recursion "},
    {"--time SECONDS", " time-limit max-time timeout seconds halttime "},
    {"--noise PERCENT", " noise-threshold adaptive-threshold noise-level error noise-limit "},
    {"--threads N", " t j jobs nthreads num-threads cores cpus "},
    {"--strategy NAME", " light-sampler lightsampler sampler sampling lightstrategy "},
    {"--tonemap NAME", " tone-mapping tonemapping tonemapper view-transform look "},
    {"--exposure STOPS", " ev stops film-exposure "},
    {"--white-balance KELVIN", " wb kelvin temperature whitepoint white-point "},
    {"--quality NAME", " preset quality-preset preview-quality draft "},
    {"--transparent", " alpha film-transparent no-background transparent-background "},
    {"--aov NAME,NAME", " aovs layers channels cryptomatte denoising-data "},
    {"--clamp X", " clamp-direct clamp-indirect firefly-clamp max-radiance maxcomponentvalue "},
    {"--seed N", " rng-seed random-seed "},
    {"--camera NAME", " cam view viewpoint "},
    {"--animation-time SECONDS", " frame f at-time "},
    {"--stats FILE.json", " statistics log report "},
    {"--progress", " verbose v "},
    {"--quiet", " silent q "},
});

}  // namespace

std::string_view equivalentOption(std::string_view option) {
  const std::string_view name =
      option.substr(std::min(option.find_first_not_of('-'), option.size()));
  const std::string word = ' ' + std::string(name) + ' ';
  for (const Equivalents& e : kEquivalents)
    if (e.names.find(word) != std::string_view::npos) return e.option;
  return {};
}

}  // namespace chromeball
