// SPDX-License-Identifier: Apache-2.0
// Text in HTML and SVG.
#pragma once

#include <string>

namespace chromeball {

// Escapes & < and ", and drops control characters.
std::string escaped(const std::string& text);

// An SVG text element, in pixels; `anchor` is start, middle or end.
std::string svgText(double x, double y, const char* anchor, const std::string& text);

}  // namespace chromeball
