// SPDX-License-Identifier: Apache-2.0
#include "progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace chromeball {
namespace {

constexpr int kWidth = 32;

std::string clockTime(double seconds) {
  const auto s = long(std::ceil(seconds));
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

ProgressBar::ProgressBar(bool shown) : shown_(shown) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::update(double fraction) {
  const Clock::time_point now = Clock::now();
  if (!shown_ || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  if (std::isnan(fraction)) {
    fmt::print(stderr, "\rrendering  {} elapsed\x1b[K", clockTime(elapsed));
  } else {
    const int full = int(fraction * kWidth);
    fmt::print(stderr, "\rrendering  [{}{}] {:3.0f}%  {} elapsed, {} remaining\x1b[K",
               std::string(full, '#'), std::string(kWidth - full, '.'), 100 * fraction,
               clockTime(elapsed),
               fraction > 0 ? clockTime(elapsed * (1 - fraction) / fraction) : "?");
  }
  std::fflush(stderr);
}

bool ProgressBar::isTerminal() { return isatty(STDERR_FILENO); }

}  // namespace chromeball
