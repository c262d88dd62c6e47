// SPDX-License-Identifier: Apache-2.0
// A forked child has none of its parent's threads, and would wait for them for ever.
#pragma once

namespace chromeball::python {

// To be called before work on all threads. Throws RunError in a child that was forked after such
// work.
void checkProcess();

}  // namespace chromeball::python
