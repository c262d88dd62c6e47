// SPDX-License-Identifier: Apache-2.0
#include "study/study.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <string_view>

#include "arrays.h"
#include "base/error.h"
#include "bindings.h"
#include "description/capabilities.h"
#include "front/scene_values.h"
#include "lighting/methods.h"
#include "measure/bias_variance.h"
#include "measure/statistics.h"
#include "plan.h"
#include "study.h"
#include "study/result_tables.h"
#include "study/results.h"

namespace chromeball::python {
namespace {

// The plan as a render of this row, with its own samples and seed. A strategy of Python's has no
// modes.
Plan renderOf(const Plan& plan, const std::string& row, uint32_t samples, uint64_t seed) {
  Plan render = plan;
  RenderDescription& description = render.description;
  if (plan.strategy.is_none()) {
    rowNamed(row, "compare()").applyTo(description);
  } else {
    description.settings = Row{}.applied(description.settings);
    description.straightGlassShadows = false;
  }
  description.settings.samples = samples;
  description.settings.seed = seed;
  if (const Conflict* found = conflictIn(description))
    throwInput("compare(): {}: {}", row, found->why);
  return render;
}

using Pair = nb::typed<nb::tuple, double, double>;  // a number and its standard error

Pair pairOf(const Estimate& e) { return nb::make_tuple(e.mean, e.standardError); }

bool isUnbiased(const Row& row) {
  const std::string_view method = std::string_view(row.strategy).substr(0, row.strategy.find(':'));
  const auto found = std::ranges::find(lightingMethods(), method, &LightingMethod::name);
  return found != lightingMethods().end() && found->isUnbiased && !row.isBiased();
}

// The samples of biased rows are not judged; nor, as bias, the mean of a strategy of Python's,
// whose pdf may be wrong.
FoundLight lightOf(const std::string& row, const BiasVariance& error) {
  if (row.empty()) return foundLight(error, false);
  return isUnbiased(rowNamed(row, "compare()")) ? foundLight(error, true) : FoundLight::All;
}

// relMSE, variance, squared bias and bias, the variance of the reference, and the light that the
// samples have found.
nb::typed<nb::tuple, Pair, Pair, Pair, Pair, double, FoundLight> errorsOf(
    const std::vector<ArrayIn<float>>& repeats, const ArrayIn<float>& reference,
    const std::optional<ArrayIn<float>>& squaredError, const std::string& row) {
  std::vector<Image> images;
  for (const ArrayIn<float>& repeat : repeats) images.push_back(imageOf(repeat));
  const Reference truth{imageOf(reference), squaredError ? imageOf(*squaredError) : Image()};
  const bool joins = !row.empty() && rowNamed(row, "compare()").joinsPixels();
  const BiasVariance e =
      biasVariance(images, truth, joins ? PixelNoise::Joined : PixelNoise::Independent);
  return nb::make_tuple(pairOf(e.relMse), pairOf(e.variance), pairOf(e.squaredBias), pairOf(e.bias),
                        e.referenceVariance, lightOf(row, e));
}

// `rows`: names, the light that they have found, and their bias.
std::vector<std::string> lightWarningsOf(
    const std::vector<std::tuple<std::string, FoundLight, double>>& rows, bool referenceIsGiven) {
  std::vector<LightOfRow> lights;
  for (const auto& [name, light, bias] : rows) lights.push_back({name, light, bias});
  return lightWarnings(lights, referenceIsGiven);
}

nb::typed<nb::tuple, double, int, double> chiSquareOf(const std::vector<double>& observed,
                                                      const std::vector<double>& expected) {
  const ChiSquare test = chiSquareTest(observed, expected);
  return nb::make_tuple(test.statistic, test.degreesOfFreedom, test.pValue);
}

}  // namespace

void keepCompared(SceneFile& scene, const Settings& given, const std::string& caller) {
  if (scene.composite)
    throwInput("{}: the scene has a composite; strategies are compared without", caller);
  for (const Setting& setting : settingTable()) {
    if (!setting.renderOnly) continue;
    if (given.has(setting.name()))
      throwInput("{}: {} is no setting of a comparison, which varies or ignores it", caller,
                 keywordOf(setting.name()));
    scene.settings.erase(setting.name());
  }
}

void bindStudy(nb::module_& m) {
  m.attr("REFERENCE") = kReference;
  m.attr("REFERENCE_PARTS") = Study::kReferenceParts;
  m.attr("MIN_REPEATS") = Study::kMinRepeats;
  nb::enum_<FoundLight>(m, "FoundLight", "Whether the samples of a row have found all light.")
      .value("ALL", FoundLight::All)
      .value("FEW", FoundLight::Few)
      .value("MISSED", FoundLight::Missed);
  m.def(
      "seed_of",
      [](const std::string& row, uint32_t samples, int repeat, uint64_t seed) {
        return seedOf({row, {false, double(samples)}, repeat}, seed);
      },
      nb::arg("row"), nb::arg("samples"), nb::arg("repeat"), nb::arg("seed"),
      "The seed of a render of a comparison.");
  m.def(
      "row_name", [](const std::string& name) { return rowNamed(name, "compare()").name(); },
      nb::arg("name"), "The complete name of a row, such as importance+denoise.");
  m.def("render_of", renderOf, nb::arg("plan"), nb::arg("row"), nb::arg("samples"),
        nb::arg("seed"));
  m.def("errors_of", errorsOf, nb::arg("repeats"), nb::arg("reference"),
        nb::arg("squared_error").none(), nb::arg("row"));
  m.def("light_warnings", lightWarningsOf, nb::arg("rows"), nb::arg("reference_is_given"));
  m.def(
      "bias_text",
      [](double bias, double error, bool missedLight) {
        return biasText({bias, error}, missedLight ? FoundLight::Missed : FoundLight::All);
      },
      nb::arg("bias"), nb::arg("standard_error"), nb::arg("missed_light"),
      "In percent: 3.1 +- 0.4, or \"not significant (+- 0.4)\": the 95% interval.");
  m.def(
      "positive_text",
      [](double mean, double error) {
        return positiveText({mean, error});
      },
      nb::arg("mean"), nb::arg("standard_error"), "The same for a mean of positive numbers.");
  m.def("chi_square_p_value", chiSquarePValue, nb::arg("statistic"), nb::arg("degrees_of_freedom"),
        "The probability of such a statistic.");
  m.def("chi_square", chiSquareOf, nb::arg("observed"), nb::arg("expected"),
        "Statistic, degrees of freedom and p-value; cells of few expected counts are pooled.");
}

}  // namespace chromeball::python
