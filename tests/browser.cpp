// SPDX-License-Identifier: Apache-2.0
#include "browser.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "run_command.h"

std::string findChromium() {
  for (const char* path :
       {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"})
    if (std::filesystem::exists(path)) return path;
  return "";
}

std::string dumpedPage(const std::string& chromium, const TemporaryFolder& folder,
                       const std::string& address, const std::string& options, int virtualSeconds) {
  const std::string command =
      chromium +
      " --headless --no-sandbox --disable-gpu --disable-quic --no-first-run"
      " --disable-background-networking --disable-component-update --disable-sync"
      " --virtual-time-budget=" +
      std::to_string(1000 * virtualSeconds) + " --user-data-dir=" + folder / "profile" + ' ' +
      options + " --dump-dom " + address + " > " + folder / "dom.html" + " 2> " + folder / "log";
  EXPECT_EQ(std::system(command.c_str()), 0) << fileContents(folder / "log");
  return fileContents(folder / "dom.html");
}

std::string extensionIn(const TemporaryFolder& folder, const std::string& script) {
  const std::string path = folder / "extension";
  std::filesystem::create_directory(path);
  std::ofstream(path + "/manifest.json") << R"({
    "manifest_version": 3, "name": "use", "version": "1",
    "content_scripts": [{"matches": ["http://127.0.0.1/*"], "js": ["use.js"],
                         "run_at": "document_end", "world": "MAIN"}]})";
  std::ofstream(path + "/use.js") << script;
  return "--disable-extensions-except=" + path + " --load-extension=" + path;
}
