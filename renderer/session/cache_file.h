// SPDX-License-Identifier: Apache-2.0
// The irradiance cache of a render, and the file that keeps it for later ones (--cache).
#pragma once

#include <optional>
#include <string>

#include "approximate/irradiance_cache.h"
#include "session/load_scene.h"

namespace chromeball {

class CacheFile {
 public:
  // The cache of a description with RenderSettings::cacheError. Reads its file if it exists. Throws
  // InputError if the file is damaged or belongs to another scene or light, and wherever
  // checkReplaceable() does.
  explicit CacheFile(const LoadedScene& loaded);

  IrradianceCache& cache() { return cache_; }

  // Replaces the file, if the description has one and there are new records. Throws RunError.
  void write();

 private:
  void read();

  IrradianceCache cache_;
  std::optional<std::string> path_;
  std::string identity_;  // of scene and light
  size_t inFile_ = 0;     // records
};

}  // namespace chromeball
