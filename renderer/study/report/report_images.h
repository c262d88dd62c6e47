// SPDX-License-Identifier: Apache-2.0
// The pictures of a comparison's report, as the page's script reads them.
#pragma once

#include <nlohmann/json.hpp>

#include "study/render_store.h"
#include "study/results.h"

namespace chromeball {

// {width, height, heat, signed: colour tables of 256 [r, g, b],
//  reference: {rgb, exponent},                         PNG data URIs: radiance in Ward's RGBE, as a
//  pictures: [{name, budget, samples, seconds,           picture of mantissas and one of exponents
//              rgb, exponent, error}],                 one a strategy, at about equal seconds
//  errorScale: {most, decades},                        of `error`: the root of the mean over
//  repeats
//                                                        of the squared relative error, logarithmic
//  bias: [{name, map, budget}], biasScale: {most},     of the approximating ones: signed, linear;
//                                                        128 where it may be noise (2 sigma)
//  pairs: [{a, b, map, width, height}], zScale}        z, one texel a tile
nlohmann::ordered_json reportPictures(const RenderStore& store, const StudyResults& results);

// For every strategy the cell whose seconds are nearest to those that all can be compared at.
std::vector<const Cell*> equalTimeCells(const StudyResults& results);

std::string pngUri(int width, int height, int channels, std::span<const uint8_t> bytes);

}  // namespace chromeball
