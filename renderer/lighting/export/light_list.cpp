// SPDX-License-Identifier: Apache-2.0

#include <fmt/format.h>

#include "base/error.h"
#include "base/json.h"
#include "base/text.h"
#include "lighting/export/light_file.h"

namespace chromeball {
namespace {

using glm::dvec3;
using nlohmann::json;

constexpr size_t kMaxLights = 100000, kMaxMegabytes = 100;

// One light, or the list itself, with its name for errors.
class Reader {
 public:
  Reader(const json& object, std::string where) : object_(object), where_(std::move(where)) {
    if (!object.is_object()) fail("should be an object, {{ ... }}");
  }

  template <class... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> reason, Args&&... args) const {
    throwInput("{}: {}", where_, fmt::format(reason, std::forward<Args>(args)...));
  }

  void allowOnly(std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, value] : object_.items())
      if (std::ranges::find(keys, key) == keys.end())
        fail("`{}` is no key of a list of lights: {}", printableName(key), fmt::join(keys, ", "));
  }

  std::optional<dvec3> vector(const char* key) const {
    const auto member = object_.find(key);
    if (member == object_.end()) return {};
    const bool isVector = member->is_array() && member->size() == 3 &&
                          std::all_of(member->begin(), member->end(), isFiniteFloat);
    if (!isVector) fail("`{}` should be three numbers, in the range of a float", key);
    return dvec3((*member)[0].get<double>(), (*member)[1].get<double>(),
                 (*member)[2].get<double>());
  }

  std::optional<dvec3> color(const char* key) const {
    const std::optional<dvec3> value = vector(key);
    if (value && !(std::min({value->x, value->y, value->z}) >= 0))
      fail("`{}` must not be negative", key);
    return value;
  }

  double angle() const {
    const auto member = object_.find("angle");
    if (member == object_.end()) return 0;
    const double degrees = member->is_number() ? member->get<double>() : -1;
    if (degrees != 0 && !(degrees >= kLeastListedAngle && degrees <= kMaxListedAngle))
      fail("`angle` should be 0, or {} to {} degrees", kLeastListedAngle, kMaxListedAngle);
    return degrees;
  }

 private:
  static bool isFiniteFloat(const json& number) {
    return number.is_number() && std::isfinite(number.get<float>());
  }

  const json& object_;
  std::string where_;
};

DirectionalLight readLight(const Reader& light) {
  constexpr double kRounding = 0.01;
  light.allowOnly({"direction", "irradiance", "radiance", "angle"});
  const auto direction = light.vector("direction");
  if (!direction || !(glm::length(*direction) > 0))
    light.fail("`direction` should be three numbers, not all of them 0");
  const double angle = light.angle();
  const auto radiance = light.color("radiance"), irradiance = light.color("irradiance");
  if (radiance && angle == 0) light.fail("`radiance` needs an `angle` above 0");
  if (!radiance && !irradiance) light.fail("has neither `irradiance` nor `radiance`");
  const dvec3 ofRadiance = radiance ? *radiance * projectedSolidAngle(angle) : dvec3(0);
  if (radiance && irradiance &&
      glm::distance(ofRadiance, *irradiance) > kRounding * glm::length(*irradiance))
    light.fail(
        "`irradiance` is not `radiance` x solid angle of `angle`; if one of the three was edited, "
        "delete `irradiance` or `radiance`");
  const Rgb kept = Rgb(irradiance.value_or(ofRadiance));
  if (!isFinite(kept)) light.fail("`radiance` x solid angle is too large");
  if (angle > 0 && !isFinite(Rgb(dvec3(kept) / projectedSolidAngle(angle))))
    light.fail("`irradiance` / solid angle is too large");
  return {vec3(glm::normalize(*direction)), kept, float(angle)};
}

}  // namespace

LightList readLights(const std::filesystem::path& path) {
  const json root = readJsonFile(path, kMaxMegabytes, "lists of lights");
  const Reader list(root, path.string());
  const auto lights = root.find("lights");
  if (lights == root.end() || !lights->is_array())
    list.fail("has no array `lights`; `chromeball lights` and `probe split` write such lists");
  list.allowOnly({"probe", "method", "ambient", "lights"});
  if (lights->size() > kMaxLights) list.fail("has more than {} lights", kMaxLights);
  LightList result;
  for (size_t i = 0; i < lights->size(); ++i)
    result.lights.push_back(
        readLight(Reader((*lights)[i], fmt::format("{}: lights[{}]", path.string(), i))));
  if (const auto ambient = list.color("ambient")) result.ambient = Rgb(*ambient);
  return result;
}

}  // namespace chromeball
