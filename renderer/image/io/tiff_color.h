// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "image/chromaticities.h"

namespace chromeball {

// What a TIFF's first image states of its colours (TIFF 6.0, section 20: WhitePoint and
// PrimaryChromaticities); Rec. 709's for the one that it leaves out, nullopt if it states neither.
// Throws std::runtime_error if they are not two and six rational numbers.
std::optional<Chromaticities> tiffPrimaries(std::span<const uint8_t> file);

// Whether PhotometricInterpretation says that it is grey, whatever the number of its samples.
bool statesGrey(std::span<const uint8_t> file);

// Whether it has a table of the light of its integers (TransferFunction), which is not applied.
bool hasTransferTable(std::span<const uint8_t> file);

}  // namespace chromeball
