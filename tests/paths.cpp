// SPDX-License-Identifier: Apache-2.0
#include "paths.h"

const char kSourceDir[] = CHROMEBALL_SOURCE_DIR;
const char kBuildDir[] = CHROMEBALL_BUILD_DIR;
const char kCommand[] = CHROMEBALL_COMMAND;
const char kCommandServer[] = CHROMEBALL_COMMAND_SERVER;
