// SPDX-License-Identifier: Apache-2.0
// Renders in the background:
//
//   Session session(description);
//   session.start();
//   const Image& image = session.wait().color();  // linear RGB, row 0 at the top
#pragma once

#include "session/session.h"
