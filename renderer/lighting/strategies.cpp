// The one table from names to strategies.
#include "lighting/bsdf_only.h"
#include "lighting/importance.h"
#include "lighting/strategy.h"
#include "lighting/uniform.h"
#include "math/error.h"
#include "math/suggest.h"

namespace chromeball {
namespace {

using Make = std::unique_ptr<LightingStrategy> (*)(const Probe&, Mis);

struct Entry {
  const char* name;
  Make make;
};

const Entry kStrategies[] = {
    {"bsdf",
     [](const Probe& probe, Mis) -> std::unique_ptr<LightingStrategy> {
       return std::make_unique<BsdfOnly>(probe);
     }},
    {"uniform",
     [](const Probe& probe, Mis) -> std::unique_ptr<LightingStrategy> {
       return std::make_unique<Uniform>(probe);
     }},
    {"importance",
     [](const Probe& probe, Mis mis) -> std::unique_ptr<LightingStrategy> {
       return std::make_unique<Importance>(probe, mis != Mis::Off);
     }},
};

}  // namespace

std::string resolveStrategy(const std::string& name) {
  return name == "auto" ? "importance" : name;
}

std::unique_ptr<LightingStrategy> makeStrategy(const std::string& name, const Probe& probe, Mis mis,
                                               const std::string& place) {
  const std::string resolved = resolveStrategy(name);
  std::vector<std::string_view> names{"auto"};
  for (const Entry& entry : kStrategies) {
    if (resolved == entry.name) return entry.make(probe, mis);
    names.push_back(entry.name);
  }
  throwInput("{}: strategy `{}` is not known; {}", place, name, didYouMean(name, names));
}

}  // namespace chromeball
