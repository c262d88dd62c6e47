// SPDX-License-Identifier: Apache-2.0
// How much memory the process may use.
#pragma once

namespace chromeball {

// 0.8 times the machine's memory, or the process's limit if that is less. Bytes.
double memoryBudget();

}  // namespace chromeball
