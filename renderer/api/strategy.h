// SPDX-License-Identifier: Apache-2.0
// The interface of lighting strategies: directions towards the light, with their pdfs over solid
// angle. A program sets its own strategy by LightingDescription::make.
#pragma once

#include "lighting/light_source.h"
#include "lighting/strategy.h"
#include "math/vec.h"
#include "math/warp.h"
#include "probe/probe.h"
