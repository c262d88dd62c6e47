// SPDX-License-Identifier: Apache-2.0
// The exceptions that all functions throw: InputError for invalid input, RunError for failures
// while they run, Interrupted.
#pragma once

#include "base/error.h"
