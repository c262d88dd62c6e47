// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace chromeball {

std::string exrVersion();  // of the OpenEXR that this was built with

}  // namespace chromeball
