// SPDX-License-Identifier: Apache-2.0
#pragma once

// Whether this build has AddressSanitizer or ThreadSanitizer, which multiply the memory that a
// process takes and reserve terabytes of its addresses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kIsInstrumented = true;
#else
constexpr bool kIsInstrumented = false;
#endif

constexpr const char* kMeasuresMemory = "measures or limits memory, which the sanitizer multiplies";
