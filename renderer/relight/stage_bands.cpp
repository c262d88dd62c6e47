// SPDX-License-Identifier: Apache-2.0
#include "relight/stage_bands.h"

#include <algorithm>

#include "base/error.h"

namespace chromeball {

StageBands::StageBands(LightStage whole)
    : band_(std::move(whole)), top_(0), rows_(band_.height()) {}

StageBands::StageBands(StageReader file, double memory, std::string_view location)
    : file_(std::move(file)), band_{file_->basis(), {}, {}} {
  const double rows = (memory - file_->bufferBytes()) / file_->rowBytes();
  if (rows < 1)
    throwInput(
        "{}: a row of {} pixels with {} elements takes {:.3g} GB of memory; {:.3g} GB are left",
        location, width(), basis().size(), 1e-9 * (file_->rowBytes() + file_->bufferBytes()),
        1e-9 * std::max(memory, 0.0));
  rows_ = int(std::min(rows, double(height())));
}

void StageBands::forEach(const std::function<void(const LightStage& band, int top)>& visit) {
  for (int top = 0; top < height(); top += rows_) {
    read(top);
    visit(band_, top);
  }
}

LightStage StageBands::row(int y) {
  if (file_) return file_->read(y, 1);
  LightStage row{band_.basis, Image(width(), 1, band_.elements.channels), {}};
  std::copy_n(band_.elements.at(0, y), row.elements.texels.size(), row.elements.texels.data());
  return row;
}

void StageBands::read(int top) {
  if (top == top_) return;
  band_.elements = {}, band_.own = {};  // before the next is allocated
  band_ = file_->read(top, std::min(rows_, height() - top));
  top_ = top;
}

}  // namespace chromeball
