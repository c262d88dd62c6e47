// SPDX-License-Identifier: Apache-2.0
// One of several renders whose samples together are those of one render.
#pragma once

#include <cstdint>

#include "base/archive.h"

namespace chromeball {

struct RenderSettings;

// Without adaptive sampling and guides, the samples of a shard are consecutive ones of the whole
// render's. Otherwise every shard takes the first samples of the whole render, and learns from them
// what the whole render would learn: how samples are allotted, and the guides. The first shard
// keeps these, and of the later samples of a pixel's half, shard k of n keeps the k-th, the
// (k + n)-th, the (k + 2 n)-th, ...
struct Shard {
  uint32_t index = 0, count = 1;
  uint32_t samplesOfAll = 0;  // mean per pixel; 0 for a render that is not a shard
  uint32_t repeated = 0;      // samples per pixel that all shards take; 0: none
  bool isConsecutive = true;  // samples of a half; else every count-th

  void archive(Archive& a);

  // Mean samples per pixel of all shards when this one has taken `taken`; where the samples are
  // consecutive, `taken`.
  uint32_t ofAll(uint32_t taken) const;
  // The mean samples per pixel, of `taken`, that this shard keeps.
  uint32_t kept(uint32_t taken) const;

  // Where the samples are consecutive: the first of a pixel; even, so that both halves have equal
  // shares.
  uint32_t first() const { return firstOf(index); }
  // How many samples per pixel the shard takes.
  uint32_t samples() const;

 private:
  uint32_t firstOf(uint32_t i) const {
    return uint32_t(uint64_t(samplesOfAll) * i / count) & ~uint32_t(1);
  }
};

// The settings of shard `index` of `count` of a render.
RenderSettings shardOf(RenderSettings whole, uint32_t index, uint32_t count);

}  // namespace chromeball
