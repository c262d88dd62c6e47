// SPDX-License-Identifier: Apache-2.0
// Light probes, as strategies sample them, and from files.
#pragma once

#include "probe/load.h"
#include "probe/probe.h"
