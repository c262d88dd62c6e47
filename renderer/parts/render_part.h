// SPDX-License-Identifier: Apache-2.0
// Files of renders that are not complete: checkpoints, shards and crops. Each is an .exr with the
// image so far, which other programs read, and the sums of the samples behind it (exr_state.h).
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/archive.h"
#include "session/finish.h"

namespace chromeball {

// Which render a file is of, and how its image is made.
struct RenderPart {
  std::string identity;  // renderIdentity() (job_description.h)
  FinishPlan plan;

  // The first bytes of a file. Throws InputError if another version wrote it.
  void archive(Archive& a);
};

// For OutputImage::state. Both must outlive the writing.
std::function<void(Archive&)> partState(RenderPart& part, RenderResult& result);

// Without its images. Throws InputError.
RenderPart readPartHeader(const std::filesystem::path& path);

}  // namespace chromeball
