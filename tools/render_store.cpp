#include "render_store.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "image/read.h"
#include "image/write.h"
#include "math/error.h"

namespace chromeball {

namespace fs = std::filesystem;

namespace {

std::string textIn(const Metadata& metadata, const std::string& key) {
  const auto found = metadata.find(key);
  const auto* text = found == metadata.end() ? nullptr : std::get_if<std::string>(&found->second);
  return text ? *text : "";
}

double numberIn(const Metadata& metadata, const std::string& key) {
  const std::string text = textIn(metadata, key);
  double number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

void RenderStore::makeFolder() const {
  std::error_code error;
  fs::create_directories(fs::path(study_.folder) / "renders", error);
  if (error) throwRun("--output: {}: {}", study_.folder, error.message());
}

std::string RenderStore::path(const RenderKey& key) const {
  std::string strategy = key.strategy;
  std::replace(strategy.begin(), strategy.end(), ':', '.');
  return (fs::path(study_.folder) / "renders" /
          fmt::format("{}-{}-{}.exr", strategy, key.budget.label(), key.repeat + 1))
      .string();
}

std::optional<StoredRender> RenderStore::find(const RenderKey& key) const {
  if (!fs::exists(path(key))) return std::nullopt;
  const ImageFile file = readImageFile(path(key));
  const Metadata& metadata = file.metadata;
  if (const std::string made = textIn(metadata, "study"); made != study_.identity)
    throwInput("--output: {} was made for `{}`, and this is `{}`; give another folder", path(key),
               made, study_.identity);
  const std::optional<Image> color = findColor(file);
  if (!color || color->width != size_.width || color->height != size_.height)
    throwInput("--output: {} is not the render that it was: delete it", path(key));
  StoredRender render;
  render.image = *color;
  render.samples = numberIn(metadata, "samples");
  render.seconds = numberIn(metadata, "seconds");
  render.prepareSeconds = numberIn(metadata, "prepareSeconds");
  render.noise = numberIn(metadata, "noise");
  render.rays = numberIn(metadata, "rays");
  render.invalidSamples = numberIn(metadata, "invalidSamples");
  return render;
}

void RenderStore::save(const RenderKey& key, const StoredRender& render) const {
  const auto text = [](double number) { return fmt::format("{}", number); };
  writeImage(path(key), OutputImage{{{"", "RGB", render.image}},
                                    {{"study", study_.identity},
                                     {"strategy", key.strategy},
                                     {"seed", std::to_string(seedOf(key, study_.seed))},
                                     {"samples", text(render.samples)},
                                     {"seconds", text(render.seconds)},
                                     {"prepareSeconds", text(render.prepareSeconds)},
                                     {"noise", text(render.noise)},
                                     {"rays", text(render.rays)},
                                     {"invalidSamples", text(render.invalidSamples)}}});
}

}  // namespace chromeball
