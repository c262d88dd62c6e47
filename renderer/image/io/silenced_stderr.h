// SPDX-License-Identifier: Apache-2.0
// Silences libraries below OpenImageIO (libpng) that print errors besides returning them, so that
// the command prints one line about each error.
#pragma once

namespace chromeball {

// While any object of this class exists, in any thread, standard error goes to /dev/null.
class SilencedStderr {
 public:
  SilencedStderr();
  ~SilencedStderr();
  SilencedStderr(const SilencedStderr&) = delete;
  SilencedStderr& operator=(const SilencedStderr&) = delete;
};

}  // namespace chromeball
