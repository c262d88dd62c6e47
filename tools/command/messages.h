// SPDX-License-Identifier: Apache-2.0
// The library's messages on standard error.
#pragma once

#include <string>

#include "base/message.h"

namespace chromeball {

void warn(const std::string& text);  // "chromeball: warning: ..."; --quiet does not silence it
void note(const std::string& text);  // "chromeball: ...", printable() (base/text.h)

// All warnings, and the notes unless `quiet`; each with the option that resolves it.
void print(const Messages& messages, bool quiet);

// The end of a sentence: "; try --probe-scale 0.019", or "; see --memory GB"; empty without one.
std::string inWords(const std::optional<Remedy>& remedy);

}  // namespace chromeball
