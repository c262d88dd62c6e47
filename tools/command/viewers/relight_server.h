// SPDX-License-Identifier: Apache-2.0
// chromeball relight --preview: a page on which a probe is turned and swapped, and the picture
// follows.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"
#include "relight/stage/light_stage.h"

namespace chromeball {

struct NamedProbe {
  std::string name;
  Image map;  // lat-long
};

// Serves http://127.0.0.1:PORT/ to this machine alone (local_server.h).
//
//   GET /               the page
//   GET /stage.json     the picture's size, the names of the probes
//   GET /picture?probe=INDEX&yaw=DEG&pitch=DEG&roll=DEG&exposure=STOPS&tonemap=NAME
//                       the pixels for a screen, four bytes each: R, G, B, 255
//   GET /probe.png?probe=INDEX      its map, for display
//   POST /stop          ends the command
//
// `port` 0: any that is free; a note names it. Throws InputError if it cannot be opened.
void serveRelight(int port, LightStage stage, std::vector<NamedProbe> probes);

}  // namespace chromeball
