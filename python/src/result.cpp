// SPDX-License-Identifier: Apache-2.0
// Images of renders, as arrays without copies and as files.
#include "result.h"

#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "arrays.h"
#include "base/text.h"
#include "bindings.h"
#include "front/plan_render.h"
#include "front/scene_values.h"
#include "image/tonemap.h"
#include "messages.h"
#include "session/develop_image.h"
#include "values.h"

namespace chromeball::python {
namespace {

using View = nb::ndarray<nb::numpy, const float>;

const Result& resultOf(nb::handle self) { return *nb::inst_ptr<Result>(self); }

View color(nb::handle self) { return viewOf(resultOf(self).image->color(), self); }

nb::typed<nb::dict, nb::str, View> layers(nb::handle self) {
  nb::typed<nb::dict, nb::str, View> all;
  const std::vector<Layer>& found = resultOf(self).image->image.layers;
  for (size_t i = 1; i < found.size(); ++i) {
    const View view = viewOf(found[i].image, self);
    all[found[i].name.c_str()] = view;
  }
  return all;
}

Dict metadata(const Result& result) {
  Dict all;
  for (const auto& [name, value] : result.image->image.metadata)
    std::visit(
        [&, key = name.c_str()](const auto& v) {
          if constexpr (std::is_same_v<std::decay_t<decltype(v)>, Matrix44>)
            all[key] = nb::cast(std::vector<float>(v.begin(), v.end()));
          else
            all[key] = nb::cast(v);
        },
        value);
  return all;
}

// Where the objects are, to meter them; empty if the image does not tell.
Image coverageOf(const OutputImage& image) {
  for (const Layer& layer : image.layers)
    if (layer.name == "alpha") return layer.image;
  const Image& color = image.layers.front().image;
  if (color.channels < 4) return {};
  Image alpha(color.width, color.height, 1);
  for (size_t i = 0; i < alpha.pixels(); ++i) *alpha.at(i) = color.at(i)[3];
  return alpha;
}

// The display of a .png: the render's, with those of its settings that are given again.
OutputDescription shownAs(const Result& result, const Dict& keywords, const std::string& caller) {
  OutputDescription output = result.output;
  static const std::vector<std::string_view> names = {"exposure", "tonemap", "white_balance"};
  const toml::table values = tableOf(keywords, caller);
  for (const auto& [key, value] : values)
    if (std::ranges::count(names, key.str()) == 0)
      throwInput("{}: unknown keyword `{}`; {}", caller, printableName(key.str()),
                 didYouMean(key.str(), names));
  const Settings given = keywordSettings(values, caller);
  const PlannedDisplay display = planDisplay(given);
  if (given.has("output.tonemap")) output.display.tone = display.transform.tone;
  if (given.has("output.white_balance")) output.display.balance = display.transform.balance;
  if (given.has("output.exposure")) {
    output.display.exposure = display.transform.exposure;
    output.choosesExposure = display.choosesExposure;
  }
  const OutputImage& image = result.image->image;
  if (output.choosesExposure)
    output.expose(autoExposure(image.layers.front().image, coverageOf(image)));
  return output;
}

std::vector<std::pair<std::string, std::string>> save(const Result& result, const std::string& path,
                                                      const Dict& keywords) {
  RenderDescription shown;
  shown.output = shownAs(result, keywords, "save()");
  shown.output.files = {path};
  Messages messages;
  {
    const nb::gil_scoped_release released;
    checkWritable(path);
    messages = writeOutputs(shown, result.image->image);
  }
  return pairsOf(messages);
}

nb::bytes png(const Result& result, const Dict& keywords) {
  const OutputDescription output = shownAs(result, keywords, "png()");
  std::vector<uint8_t> bytes;
  {
    const nb::gil_scoped_release released;
    bytes = encodePng(result.image->color(), output.display);
  }
  return nb::bytes(bytes.data(), bytes.size());
}

}  // namespace

void bindResult(nb::module_& m) {
  nb::class_<Result>(m, "Image", "The image of a render.")
      .def_prop_ro("color", color)
      .def_prop_ro("layers", layers)
      .def_prop_ro("metadata", metadata)
      .def_prop_ro("samples", [](const Result& r) { return r.image->samples; })
      .def_prop_ro("noise", [](const Result& r) { return r.image->noise; })
      .def_prop_ro("is_complete", [](const Result& r) { return r.image->isComplete; })
      .def_prop_ro("statistics", [](const Result& r) { return r.image->statistics; })
      .def_prop_ro("messages", [](const Result& r) { return pairsOf(r.messages); })
      .def("save", save, nb::arg("path"), nb::arg("keywords"))
      .def("png", png, nb::arg("keywords"));
}

}  // namespace chromeball::python
