// SPDX-License-Identifier: Apache-2.0
// Images of floats, linear Rec. 709, row 0 at the top; reading and writing their files.
#pragma once

#include "image/image.h"
#include "image/io/read_image.h"
#include "image/io/write_image.h"
