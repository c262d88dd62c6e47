// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

// Runs the command line in a fork of a process that has its libraries already
// (tests/command_server/main.cpp). Its standard output and error go to the files. Returns the
// status of waitpid(). May be called by several threads.
int runInServer(const std::vector<std::string>& arguments, const std::string& outPath,
                const std::string& errorPath);
