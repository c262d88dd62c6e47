// SPDX-License-Identifier: Apache-2.0
#include "study/render_store.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <set>

#include "base/error.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
#include "session/image_header.h"

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

// Attributes that are numbers.
constexpr std::pair<const char*, double StoredRender::*> kNumbers[] = {
    {"samples", &StoredRender::samples},
    {"seconds", &StoredRender::seconds},
    {"prepareSeconds", &StoredRender::prepareSeconds},
    {"noise", &StoredRender::noise},
    {"rays", &StoredRender::rays},
    {"invalidSamples", &StoredRender::invalidSamples}};

// The attributes by which a file identifies its render, so that none is taken for another.
Metadata attributesOf(const RenderKey& key, uint64_t studySeed) {
  return {
      {"strategy", key.strategy},
      {key.budget.timed ? "budgetSeconds" : "budgetSamples", fmt::format("{}", key.budget.amount)},
      {"seed", std::to_string(seedOf(key, studySeed))}};
}

}  // namespace

void RenderStore::makeFolder() const {
  std::error_code error;
  fs::create_directories(fs::path(study_.folder) / "renders", error);
  if (error) throwRun("output: {}: {}", study_.folder, error.message());
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
  if (const std::string stored = textIn(metadata, "study"); stored != study_.identity)
    throwInput("output: {} belongs to another comparison: {}; choose another folder", path(key),
               differenceOf(stored, study_.identity));
  const Metadata own = attributesOf(key, study_.seed);
  const bool isOther = std::ranges::any_of(own, [&](const auto& attribute) {
    const auto found = metadata.find(attribute.first);
    return found == metadata.end() || found->second != attribute.second;
  });
  const std::optional<Image> color = findColor(file);
  if (isOther || !color || color->width != size_.width || color->height != size_.height)
    throwInput("output: {} is damaged or was changed; delete it to render it again", path(key));
  StoredRender render;
  render.image = *color;
  for (const auto& [name, number] : kNumbers) render.*number = numberIn(metadata, name);
  render.unbiased = textIn(metadata, "unbiased") == "yes";
  return render;
}

void RenderStore::save(const RenderKey& key, const StoredRender& render) const {
  Metadata metadata = attributesOf(key, study_.seed);
  metadata.insert({{"study", study_.identity}, {"unbiased", render.unbiased ? "yes" : "no"}});
  for (const auto& [name, number] : kNumbers)
    metadata.emplace(name, fmt::format("{}", render.*number));
  writeImage(path(key), OutputImage{{{"", "RGB", render.image}}, metadata});
}

std::vector<RenderKey> RenderStore::firstRepeats() const {
  std::set<std::string> paths;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(fs::path(study_.folder) / "renders", none))
    if (entry.path().string().ends_with("-1.exr")) paths.insert(entry.path().string());
  std::vector<RenderKey> keys;
  for (const std::string& path : paths) {
    const Metadata metadata = readImageFile(path).metadata;
    const bool timed = metadata.contains("budgetSeconds");
    const double amount = numberIn(metadata, timed ? "budgetSeconds" : "budgetSamples");
    RenderKey key{textIn(metadata, "strategy"), {timed, amount}, 0};
    if (key.strategy.empty() || key.strategy == kReference || amount <= 0) continue;
    if (find(key)) keys.push_back(std::move(key));
  }
  return keys;
}

}  // namespace chromeball
