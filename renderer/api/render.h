// SPDX-License-Identifier: Apache-2.0
// All of the library's public headers.
#pragma once

#include "api/description.h"
#include "api/errors.h"
#include "api/image.h"
#include "api/measure.h"
#include "api/probe.h"
#include "api/scene.h"
#include "api/scene_file.h"
#include "api/session.h"
#include "api/strategy.h"
