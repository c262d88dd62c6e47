// SPDX-License-Identifier: Apache-2.0
#include "lighting/area_lights.h"

#include "base/hash.h"
#include "probe/mapping.h"

namespace chromeball {
namespace {

constexpr double kMargin = 1e-5;  // radians, for rounding in at()

double angleBetween(const dvec3& a, const dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

DiscAreas::DiscAreas(std::vector<AreaLight> lights) : cells_(size_t(kRows) * kColumns) {
  lights_ = std::move(lights);
  for (const AreaLight& light : lights_) {
    discs_.push_back({Frame(light.direction), float(light.solidAngle / kPiD)});
    found_.push_back({light.radiance(), float(1 / light.solidAngle)});
  }
  listCells();
}

// A disc is listed in a cell if it may reach the circle around the cell's corners.
void DiscAreas::listCells() {
  for (int row = 0; row < kRows; ++row) {
    const auto at = [&](double column, double down) {
      return *uvToDirection(Mapping::LatLong, {column / kColumns, (row + down) / kRows});
    };
    const double cell =
        std::max(angleBetween(at(0.5, 0.5), at(0, 0)), angleBetween(at(0.5, 0.5), at(0, 1)));
    std::vector<dvec3> middles;
    for (int column = 0; column < kColumns; ++column) middles.push_back(at(column + 0.5, 0.5));
    for (size_t i = 0; i < discs_.size(); ++i) {
      const double disc = std::acos(std::max(-1.0, 1 - 0.5 * discs_[i].squaredChord));
      const double nearest = std::cos(std::min(disc + cell + kMargin, kPiD));
      for (int column = 0; column < kColumns; ++column)
        if (glm::dot(middles[column], dvec3(discs_[i].frame.z)) >= nearest)
          cells_[size_t(row) * kColumns + column].push_back(uint16_t(i));
    }
  }
}

const std::vector<uint16_t>& DiscAreas::cellOf(const vec3& wi) const {
  const float u = 0.5f + atan2Turns(wi.x, -wi.z);
  const float v = 2 * atan2Turns(std::sqrt(wi.x * wi.x + wi.z * wi.z), wi.y);
  // Clamped on both sides: a NaN direction must not read outside the table.
  const int column = std::clamp(int(u * kColumns), 0, kColumns - 1);
  const int row = std::clamp(int(v * kRows), 0, kRows - 1);
  return cells_[size_t(row) * kColumns + column];
}

LightAreas::Found DiscAreas::at(const vec3& wi) const {
  Found found;
  for (const uint16_t i : cellOf(wi))
    if (discs_[i].contains(wi)) {
      found.radiance += found_[i].radiance;
      found.density += found_[i].density;
    }
  return found;
}

void DiscAreas::split(const vec3& wi, std::span<Rgb> radiances) const {
  for (const uint16_t i : cellOf(wi))
    if (discs_[i].contains(wi)) radiances[i] += found_[i].radiance;
}

LightAreas::Sample DiscAreas::sample(size_t light, double u, double v) const {
  const vec3 direction = discs_[light].direction(float(u), float(v));
  return {direction, at(direction)};
}

void RegionAreas::Region::add(const Rectangle& run, double runSolidAngle) {
  const double sum = solidAngle() + runSolidAngle;
  if (!rectangles.empty()) {
    Rectangle& last = rectangles.back();
    if (last.y1 == run.y0 && last.x0 == run.x0 && last.x1 == run.x1) {
      last.y1 = run.y1, last.sum = sum;
      return;
    }
  }
  rectangles.push_back({run.x0, run.x1, run.y0, run.y1, sum});
}

std::vector<RegionAreas::Region> RegionAreas::regionsOf(const Image& latLong) const {
  std::vector<dvec3> column(width_);  // directions on the horizon
  for (int x = 0; x < width_; ++x) column[x] = texelDirection({width_, 1}, x, 0);
  std::vector<Region> regions(partition_.regions);
  for (int y = 0; y < height_; ++y) {
    const double theta = kPiD * (y + 0.5) / height_;
    const double sine = std::sin(theta), cosine = std::cos(theta);
    const double texel = texelSolidAngle(y, width_, height_);
    const uint16_t* label = &partition_.label[size_t(y) * width_];
    for (int x0 = 0, x1; x0 < width_; x0 = x1) {
      for (x1 = x0 + 1; x1 < width_ && label[x1] == label[x0];) ++x1;
      if (label[x0] == kNoRegion) continue;
      Region& region = regions[label[x0]];
      region.add({x0, x1, y, y + 1, 0}, texel * (x1 - x0));
      for (int x = x0; x < x1; ++x) {
        const dvec3 power = dvec3(latLong.rgb(x, y)) * texel;
        const double weight = luminance(power);
        const dvec3 direction(sine * column[x].x, cosine, sine * column[x].z);
        region.energy += {power, direction * weight, weight};
      }
    }
  }
  return regions;
}

RegionAreas::RegionAreas(const Image& latLong, Partition partition, const Rotation& rotation)
    : width_(latLong.width),
      height_(latLong.height),
      turn_(rotation),
      partition_(std::move(partition)) {
  if (partition_.regions == 0) return;
  std::vector<uint16_t> lightOf;  // each region
  for (Region& region : regionsOf(latLong)) {
    const bool isLit = region.energy.weight > 0;
    lightOf.push_back(isLit ? uint16_t(lights_.size()) : kNoRegion);
    if (!isLit) continue;
    const Rectangle& first = region.rectangles.front();
    const DirectionalLight light =
        lightAt(region.energy, texelDirection({width_, height_}, first.x0, first.y0));
    const dvec3 direction = glm::normalize(rotation.quaternion() * dvec3(light.direction));
    lights_.push_back({vec3(direction), light.irradiance, region.solidAngle()});
    found_.push_back({lights_.back().radiance(), float(1 / region.solidAngle())});
    regions_.push_back(std::move(region));
  }
  for (uint16_t& label : partition_.label)
    if (label != kNoRegion) label = lightOf[label];
}

uint16_t RegionAreas::lightIn(const vec3& wi) const {
  if (lights_.empty()) return kNoRegion;
  const vec3 d = turn_.toMap(wi);
  float u = 0.5f + atan2Turns(d.x, -d.z) - turn_.uShift();
  u -= std::floor(u);
  const float v = 2 * atan2Turns(std::sqrt(d.x * d.x + d.z * d.z), d.y);
  // Clamped on both sides: a NaN direction must not read outside the map.
  const int x = std::clamp(int(u * float(width_)), 0, width_ - 1);
  const int y = std::clamp(int(v * float(height_)), 0, height_ - 1);
  return partition_.label[size_t(y) * width_ + x];
}

LightAreas::Found RegionAreas::at(const vec3& wi) const {
  const uint16_t light = lightIn(wi);
  return light == kNoRegion ? Found{} : found_[light];
}

void RegionAreas::split(const vec3& wi, std::span<Rgb> radiances) const {
  const uint16_t light = lightIn(wi);
  if (light != kNoRegion) radiances[light] += found_[light].radiance;
}

LightAreas::Sample RegionAreas::sample(size_t light, double u, double v) const {
  const std::vector<Rectangle>& rectangles = regions_[light].rectangles;
  const double target = v * regions_[light].solidAngle();
  const auto chosen = std::upper_bound(rectangles.begin(), rectangles.end() - 1, target,
                                       [](double sum, const Rectangle& r) { return sum < r.sum; });
  const double before = chosen == rectangles.begin() ? 0 : (chosen - 1)->sum;
  const double t = std::clamp((target - before) / (chosen->sum - before), 0.0, 1.0);
  // The solid angle is azimuth x cosine of the polar angle.
  const double top = std::cos(kPiD * chosen->y0 / height_);
  const double bottom = std::cos(kPiD * chosen->y1 / height_);
  const double cosine = top + t * (bottom - top);
  const float sine = float(std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine))));
  const double x = chosen->x0 + u * (chosen->x1 - chosen->x0);
  float sinPhi, cosPhi;
  sinCosTurns(float(x / width_) + turn_.uShift(), sinPhi, cosPhi);
  // u = 1/2 shows -Z, as in Probe::direction.
  return {turn_.toWorld({-sine * sinPhi, float(cosine), sine * cosPhi}), found_[light]};
}

AreaLights::AreaLights(const Probe& probe, std::unique_ptr<const LightAreas> areas)
    : ProbeLight(probe),
      areas_(std::move(areas)),
      choice_(1, std::max(1, int(areas_->lights().size()))) {
  std::vector<double> powers;
  for (const AreaLight& light : areas_->lights()) powers.push_back(luminance(light.power));
  if (!powers.empty()) power_ = choice_.setRow(0, powers);
}

float AreaLights::pdf(const LightAreas::Found& found, int depth) const {
  if (samplesAll(depth)) return found.density;
  // Each light contributes power / (all power) x 1 / solid angle: in proportion to its radiance.
  return float(kLater * luminance(glm::dvec3(found.radiance)) / power_);
}

void AreaLights::sample(const LightPoint& point, const PixelSampler& sampler,
                        std::vector<DirectionSample>& out) const {
  if (!(power_ > 0)) return;
  const uint32_t u = sampler.bits(dimension::kLight), v = sampler.bits(dimension::kLight + 1);
  const auto append = [&](size_t light, double s, double t) {
    const LightAreas::Sample at = areas_->sample(light, s, t);
    if (const float density = pdf(at.found, point.depth); density > 0)
      out.push_back({at.direction, at.found.radiance / density, density});
  };
  if (!samplesAll(point.depth)) {
    for (int k = 0; k < kLater; ++k) {
      double choice = (k + u * 0x1p-32) / kLater;
      const int light = choice_.sample(0, choice);
      append(size_t(light), choice, v * 0x1p-32);
    }
    return;
  }
  // All lights use the same stratified point, with a different digital shift in each.
  for (size_t light = 0; light < areas_->lights().size(); ++light) {
    const uint64_t shift = hash(uint64_t(light));
    append(light, (u ^ uint32_t(shift)) * 0x1p-32, (v ^ uint32_t(shift >> 32)) * 0x1p-32);
  }
}

LightSource::Escaped AreaLights::escaped(const LightPoint& point, const vec3& wi) const {
  if (!(power_ > 0)) return {Rgb(0), 0};
  const LightAreas::Found found = areas_->at(wi);
  return {found.radiance, pdf(found, point.depth)};
}

std::vector<std::string> AreaLights::groups() const {
  std::vector<std::string> names;
  for (size_t i = 0; i < areas_->lights().size(); ++i) names.push_back(std::to_string(i));
  names.push_back("background");
  return names;
}

float AreaLights::mirrorAlpha() const {
  return areas_->lights().empty() ? 0 : 1 / std::sqrt(float(areas_->lights().size()));
}

}  // namespace chromeball
