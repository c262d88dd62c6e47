// SPDX-License-Identifier: Apache-2.0
// Errors between images.
#pragma once

#include "measure/image_error.h"
