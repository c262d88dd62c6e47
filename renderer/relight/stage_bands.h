// SPDX-License-Identifier: Apache-2.0
// A light stage by bands of rows, so that a file larger than the memory can be summed.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "relight/stage_file.h"

namespace chromeball {

class StageBands {
 public:
  explicit StageBands(LightStage whole);  // one band
  // Bands of a file that take at most `memory` bytes, with all that reading takes. Throws
  // InputError, begun by `location`, if a row takes more.
  StageBands(StageReader file, double memory, std::string_view location);

  const DirectionBasis& basis() const { return file_ ? file_->basis() : band_.basis; }
  int width() const { return file_ ? file_->width() : band_.width(); }
  int height() const { return file_ ? file_->height() : band_.height(); }

  // Calls visit(band, top) for all rows, from the top down. A band stays in memory until the next
  // is read, so that a stage of one band is read once.
  void forEach(const std::function<void(const LightStage& band, int top)>& visit);

  LightStage row(int y);

 private:
  void read(int top);

  std::optional<StageReader> file_;
  LightStage band_;
  int top_ = -1;  // of the band in memory; -1: none
  int rows_;      // of a band
};

}  // namespace chromeball
