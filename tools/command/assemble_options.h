// SPDX-License-Identifier: Apache-2.0
// The options of `chromeball probe assemble`.
#pragma once

#include "command.h"

#include "probe/capture/assemble.h"
#include "probe/capture/find_circle.h"

namespace chromeball {

// The arguments as given.
struct AssembleArguments {
  std::vector<std::string> photographs, azimuths, circles, masks;
  std::string out, from = "mirror-ball", to = "lat-long", size, fill = "inpaint", preview;
  std::string distance, reflectivity, ballIor, cameraDisc;
  bool schlick = false, keepExposure = false, keepAzimuth = false, json = false;

  bool isFisheye() const { return from != "mirror-ball"; }
};

void addAssembleOptions(Command command, AssembleArguments& arguments);

// One photograph with all that is needed to read it.
struct AssemblyPhotograph {
  std::string file;
  Image image, mask;
  Circle circle;
  std::optional<FoundCircle> found;  // if the circle was not given
  CameraPosition camera;
};

// The mapping and size of the output, and the size of the lat-long map in which views are merged.
struct AssemblyTarget {
  Mapping mapping;
  ImageSize size, merged;
};

// These throw InputError.
void checkFiles(const AssembleArguments& arguments);
std::shared_ptr<const CaptureOptics> parseOptics(const AssembleArguments& arguments,
                                                 const Command& command);
BlindFill parseFill(const std::string& text);
std::vector<AssemblyPhotograph> loadPhotographs(const AssembleArguments& arguments);  // and warns
AssemblyTarget parseTarget(const AssembleArguments& arguments,
                           const std::vector<CaptureView>& views);

}  // namespace chromeball
