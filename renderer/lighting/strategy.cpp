// SPDX-License-Identifier: Apache-2.0
// Strategies by name, from the table of methods.h.
#include "lighting/strategy.h"

#include <fmt/format.h>

#include <charconv>

#include "base/error.h"
#include "base/text.h"
#include "lighting/methods.h"

namespace chromeball {
namespace {

const LightingMethod* findMethod(std::string_view name) {
  for (const LightingMethod& method : lightingMethods())
    if (method.name == name) return &method;
  return nullptr;
}

int parseCount(std::string_view text, const LightingMethod& method, const std::string& location) {
  const auto& [min, max, usual] = method.counts;
  if (max == 0)
    throwInput("{}: strategy `{}` takes no count; leave out `:{}`", location, method.name, text);
  int count = 0;
  const char* end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, count);
  if (error != std::errc() || parsed != end || count < min || count > max)
    throwInput(
        "{}: strategy `{}` cannot take the count `{}`; give {}:{} to {}:{}, or no count for {}",
        location, method.name, text, method.name, min, method.name, max, usual);
  return count;
}

std::vector<std::string_view> namesAndAuto() {
  std::vector<std::string_view> names = strategyNames();
  names.insert(names.begin(), "auto");
  return names;
}

}  // namespace

std::vector<std::string_view> strategyNames() {
  std::vector<std::string_view> names;
  for (const LightingMethod& method : lightingMethods()) names.push_back(method.name);
  return names;
}

bool hasLights(const std::string& name) {
  const std::string resolved = resolveStrategy(name);
  const LightingMethod* method = findMethod(resolved.substr(0, resolved.find(':')));
  return !method || method->replacesProbe;
}

std::string resolveStrategy(const std::string& name) {
  if (name == "auto") return "importance";
  const LightingMethod* method = findMethod(name);
  return method && method->counts.max > 0 ? fmt::format("{}:{}", name, method->counts.usual) : name;
}

std::unique_ptr<LightSource> makeStrategy(const std::string& name, const Probe& probe,
                                          const StrategyOptions& options,
                                          const std::string& location) {
  const std::string resolved = resolveStrategy(name);
  const size_t colon = resolved.find(':');
  const LightingMethod* method = findMethod(std::string_view(resolved).substr(0, colon));
  if (!method)
    throwInput("{}: unknown strategy `{}`; {}", location, name,
               didYouMean(resolved.substr(0, colon), namesAndAuto()));
  int count = 0;
  if (colon != std::string::npos)
    count = parseCount(std::string_view(resolved).substr(colon + 1), *method, location);
  return method->makeStrategy(probe, options, count);
}

}  // namespace chromeball
