// SPDX-License-Identifier: Apache-2.0
// The exceptions that all functions throw: InputError for what they are given, RunError for
// failures while they run, Interrupted.
#pragma once

#include "base/error.h"
