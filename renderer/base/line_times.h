// SPDX-License-Identifier: Apache-2.0
// When the progress of long work is worth a line of a log.
#pragma once

namespace chromeball {

// A tenth more is done, or a minute has passed; not in the first ten seconds, nor sooner than that
// after another line.
class LineTimes {
 public:
  // `fraction` done may be NaN; `seconds` since the work began. If true, there is a line now.
  bool isDue(double fraction, double seconds);

 private:
  double fraction_ = 0, seconds_ = 0;  // at the last line
};

}  // namespace chromeball
