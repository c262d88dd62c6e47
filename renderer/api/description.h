// SPDX-License-Identifier: Apache-2.0
// Everything that decides an image, as values.
#pragma once

#include "description/render_description.h"
