// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace chromeball {

// The setting that resolves what an error or a message is about, by its name in the table of
// settings (front/setting_table.h: "probe.scale"). The command prints the option that sets it.
struct Remedy {
  std::string setting;
  std::string value;  // one that would do; empty: unknown
};

}  // namespace chromeball
