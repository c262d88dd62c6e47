// SPDX-License-Identifier: Apache-2.0
// Libraries under OpenImageIO (libpng) print what they find wrong, besides reporting it; the
// command owes its user one line.
#pragma once

namespace chromeball {

// Standard error goes nowhere while any of these lives, in any thread.
class QuietStandardError {
 public:
  QuietStandardError();
  ~QuietStandardError();
  QuietStandardError(const QuietStandardError&) = delete;
  QuietStandardError& operator=(const QuietStandardError&) = delete;
};

}  // namespace chromeball
