// SPDX-License-Identifier: Apache-2.0
#include "progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace chromeball {
namespace {

constexpr int kBarWidth = 32, kLeastBarWidth = 8;

int terminalColumns() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 100;
}

std::string clockTime(double seconds) {
  const auto s = long(std::ceil(seconds));
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60)
                  : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

// "42%  0:10 elapsed, 0:14 remaining"
std::string timesInWords(double fraction, double elapsed) {
  const std::string times = fmt::format("{} elapsed", clockTime(elapsed));
  if (std::isnan(fraction)) return times;
  return fmt::format("{:3.0f}%  {}, {} remaining", 100 * fraction, times,
                     fraction > 0 ? clockTime(elapsed * (1 - fraction) / fraction) : "?");
}

}  // namespace

ProgressStyle progressStyle(const Verbosity& given) {
  if (given.progress) return ProgressStyle::Bar;
  if (given.quiet) return ProgressStyle::None;
  return isatty(STDERR_FILENO) ? ProgressStyle::Bar : ProgressStyle::Lines;
}

ProgressBar::ProgressBar(ProgressStyle style, std::string title)
    : style_(style), title_(std::move(title)) {}

ProgressBar::~ProgressBar() {
  if (drawn_) writeError("\r\x1b[K");
}

void ProgressBar::update(double fraction) {
  if (style_ == ProgressStyle::None) return;
  const Clock::time_point now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  if (style_ == ProgressStyle::Lines) {
    if (lines_.isDue(fraction, elapsed))
      note(fmt::format("{} {}{}", title_, timesInWords(fraction, elapsed),
                       description_.empty() ? "" : ", " + description_));
    return;
  }
  const bool ends = fraction >= 1 && !ended_;  // which is drawn at once
  if (!ends && now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  ended_ = fraction >= 1;
  drawn_ = true;
  draw(fraction, timesInWords(fraction, elapsed));
}

void ProgressBar::draw(double fraction, const std::string& times) {
  const int columns = terminalColumns();
  const std::string described =
      description_.empty() ? times : fmt::format("{}, {}", times, description_);
  const bool fits = int(title_.size() + described.size()) + kLeastBarWidth + 5 < columns;
  const std::string& text = fits ? described : times;
  if (std::isnan(fraction)) {
    writeError(fmt::format("\r{}  {}\x1b[K", title_, text));
  } else {
    const int room = columns - int(title_.size() + text.size()) - 6;
    const int width = std::clamp(room, kLeastBarWidth, kBarWidth), full = int(fraction * width);
    writeError(fmt::format("\r{}  [{}{}] {}\x1b[K", title_, std::string(full, '#'),
                           std::string(width - full, '.'), text));
  }
}

BusyLine::BusyLine(std::string title) {
  if (progressStyle() != ProgressStyle::Bar) return;
  thread_ = std::thread([this, title = std::move(title)] {
    ProgressBar bar(ProgressStyle::Bar, title);
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, std::chrono::seconds(1), [this] { return done_; }))
      bar.update(std::numeric_limits<double>::quiet_NaN());
  });
}

BusyLine::~BusyLine() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

}  // namespace chromeball
