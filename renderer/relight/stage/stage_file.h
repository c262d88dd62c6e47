// SPDX-License-Identifier: Apache-2.0
// The file of a light stage, an .exr, written and read by bands of rows: R, G, B are the picture
// under unit radiance from everywhere with the scene's own light, then the layers element.0000,
// element.0001, ... and own; the attribute `basis` names the functions.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "image/io/exr_rows.h"
#include "relight/stage/light_stage.h"

namespace chromeball {

// Atomic: the file appears with commit(); without that, nothing remains.
class StageWriter {
 public:
  // `like`: any band. `halves`: in 16 bits. Throws RunError, as all functions do.
  StageWriter(const std::filesystem::path& path, const LightStage& like, int height,
              Metadata metadata, bool halves);

  // The next rows, from the top down; `color`: their R, G, B.
  void write(const LightStage& band, const Image& color);
  void commit() { file_.commit(); }
  uint64_t clipped() const { return file_.clipped(); }  // numbers beyond the range of halves

  // The most memory that writing takes besides the band, in bytes.
  static double bufferBytes(const DirectionBasis& basis, int width);

 private:
  ExrRowsWriter file_;
};

class StageReader {
 public:
  // Colour with other primaries is converted to linear Rec. 709. Throws InputError for a file that
  // is not a light stage, that lacks elements, or whose data window is not its display window.
  explicit StageReader(const std::filesystem::path& path);

  const DirectionBasis& basis() const { return basis_; }
  int width() const { return file_.width(); }
  int height() const { return file_.height(); }
  const Messages& messages() const { return messages_; }  // that colour is converted

  // `count` rows from `top` on. Throws InputError for values that are not finite.
  LightStage read(int top, int count);

  // The most memory that a row takes while it is read, and that reading takes in addition, in
  // bytes.
  double rowBytes() const;
  double bufferBytes() const { return file_.bufferBytes(); }

 private:
  std::filesystem::path path_;
  ExrRowsReader file_;
  DirectionBasis basis_;
  std::optional<glm::dmat3> toRec709_;  // nullopt: it is
  Messages messages_;
  std::vector<size_t> elements_, own_;  // positions of their channels; empty: there are none
};

// A light stage by bands of rows, so that a file larger than the memory can be summed.

class StageBands {
 public:
  explicit StageBands(LightStage whole);  // one band
  // Bands of a file that take at most `memory` bytes, including the memory for reading. Throws
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
