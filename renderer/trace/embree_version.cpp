// SPDX-License-Identifier: Apache-2.0
#include "trace/embree_version.h"

#include <fmt/format.h>

#include "base/error.h"
#include "trace/embree.h"

namespace chromeball {

EmbreeVersion embreeVersion() {
  const RTCDevice device = rtcNewDevice(nullptr);
  if (!device) throwRun("Embree does not start: error {}", int(rtcGetDeviceError(nullptr)));
  const auto get = [&](RTCDeviceProperty property) {
    return int(rtcGetDeviceProperty(device, property));
  };
  const EmbreeVersion found{
      fmt::format("{}.{}.{}", get(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                  get(RTC_DEVICE_PROPERTY_VERSION_MINOR), get(RTC_DEVICE_PROPERTY_VERSION_PATCH)),
      get(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)  ? 16
      : get(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8
                                                       : 4};
  rtcReleaseDevice(device);
  return found;
}

}  // namespace chromeball
