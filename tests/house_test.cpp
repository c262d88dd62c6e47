// SPDX-License-Identifier: Apache-2.0
// The layout of the source tree: the allowed includes between folders, the one folder that includes
// each third-party library, the contents of the top level, and the licence of every file.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "paths.h"
#include "regular_expression.h"

namespace house_test {
namespace {

namespace fs = std::filesystem;

// Folder of renderer/: the folders it may include besides itself. A nested folder has its own row;
// it and its parent may include each other only if their rows list it.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"base", {}},
    {"math", {"base"}},
    {"image", {"base", "math"}},
    {"image/io", {"base", "math", "image"}},
    {"image/imageio", {"image/io"}},
    {"image/develop", {"base", "math", "image"}},
    {"probe", {"base", "math", "image", "image/io"}},
    {"probe/capture", {"base", "math", "image", "image/io", "probe"}},
    {"scene", {"base", "math", "image", "image/io", "probe"}},
    {"scene/builder", {"base", "math", "scene"}},
    {"scene/gltf", {"base", "math", "image", "image/io", "probe", "scene", "scene/builder"}},
    {"scene/solve", {"base", "math", "image", "probe", "scene"}},
    {"trace", {"base", "math", "scene"}},
    {"shading", {"base", "math", "scene"}},
    {"lighting/constellation", {"base", "math", "image", "probe"}},
    {"lighting/fit", {"base", "math", "image", "probe", "lighting/constellation"}},
    {"lighting/export", {"base", "image", "lighting/constellation", "math", "probe", "scene"}},
    {"lighting",
     {"base", "math", "image", "probe", "scene", "shading", "lighting/constellation",
      "lighting/fit"}},
    {"film", {"base", "math", "image"}},
    {"denoise", {"base", "math", "image", "film"}},
    {"guiding", {"base", "math"}},
    {"transport", {"base", "math", "scene", "trace", "shading", "lighting", "film", "guiding"}},
    {"approximate",
     {"base", "math", "image", "probe", "scene", "trace", "shading", "lighting", "film",
      "transport"}},
    {"render", {"base", "scene", "film", "transport", "approximate"}},
    {"composite",
     {"base", "math", "image", "image/io", "scene", "trace", "film", "transport", "approximate",
      "render", "denoise", "scene/builder"}},
    {"relight/stage",
     {"base", "image", "image/io", "lighting", "math", "probe", "render", "transport"}},
    {"relight/transfer",
     {"bake", "base", "film", "math", "relight/stage", "scene/gltf", "transport"}},
    {"bake", {"base", "math", "image", "image/io", "scene", "film", "transport", "approximate"}},
    {"measure", {"base", "image"}},
    {"description",
     {"base", "math", "image", "image/develop", "probe", "scene", "scene/gltf", "lighting", "film",
      "render", "composite"}},
    {"front",
     {"base", "math", "image", "image/io", "image/develop", "probe", "scene", "scene/gltf",
      "scene/solve", "lighting", "render", "composite", "description", "lighting/export"}},
    {"animation", {"base", "scene"}},
    {"session", {"base",      "math",    "image",         "image/io",    "image/develop",
                 "probe",     "scene",   "scene/builder", "scene/gltf",  "trace",
                 "lighting",  "film",    "transport",     "approximate", "render",
                 "composite", "denoise", "description",   "animation",   "relight/stage"}},
    {"parts", {"base", "image/io", "render", "session"}},
    {"api",
     {"base", "math", "image", "image/io", "probe", "scene", "scene/builder", "lighting", "measure",
      "description", "front", "session"}},
    {"study",
     {"base", "image", "image/io", "probe", "scene", "lighting", "render", "measure", "description",
      "session"}},
    {"study/report",
     {"base", "image", "image/io", "probe", "lighting", "measure", "session", "study"}},
};

// Header of a library: the only folders or files that may include it, as path prefixes.
const std::map<std::string, std::vector<std::string>> kIncludedBy = {
    {"rtcore.h", {"renderer/trace/"}},
    {"OpenImageIO/", {"renderer/image/imageio/"}},
    {"OpenEXR/", {"renderer/image/io/exr_", "tests/exr_files_test.cpp"}},
    {"png.h",
     {"renderer/image/io/png_color.cpp", "renderer/image/io/write_image.cpp",
      "tests/image_readers_test.cpp"}},
    {"jpeglib.h", {"renderer/image/io/jpeg_reader.cpp", "tests/image_readers_test.cpp"}},
    {"webp/", {"renderer/image/io/decode_image.cpp"}},
    {"draco/", {"renderer/scene/gltf/draco.cpp"}},
    {"meshoptimizer.h", {"renderer/scene/gltf/meshopt.cpp"}},
    {"blosc.h", {"renderer/image/io/exr_state.cpp"}},
    {"xxhash.h", {"renderer/base/hash.cpp"}},
    {"tiny_gltf.h", {"renderer/scene/gltf/"}},
    {"toml++/", {"renderer/front/toml_section.h"}},
    {"nlohmann/json.hpp", {"renderer/base/json.h"}},
    {"base/json.h",
     {"renderer/base/json.cpp", "renderer/bake/gltf_document.h", "renderer/description/",
      "renderer/front/", "renderer/session/", "renderer/lighting/export/light_",
      "renderer/scene/gltf/", "renderer/scene/solve/", "renderer/study/", "tools/", "tests/"}},
    {"Eigen/",
     {"renderer/math/dense_", "renderer/math/dense_solvers.cpp", "renderer/lighting/fit/",
      "renderer/scene/solve/", "renderer/relight/transfer/clustered_pca.cpp"}},
    {"boost/", {"renderer/measure/", "renderer/probe/cube_faces.cpp"}},
    {"tbb/", {"renderer/base/parallel.cpp"}},
    {"CLI/",
     {"tools/command/command.cpp", "tools/command/command_line.cpp", "tools/command/help.h"}},
    {"httplib.h", {"tools/command/viewers/"}},
};

// The forbidden includes in the file `path` (relative to the project), one line each.
std::vector<std::string> violations(const std::string& path, const std::string& text) {
  std::vector<std::string> found;
  static const std::string kInclude = R"((?:^|\n)\s*#\s*include\s*([<"])([^>"]+)[>"])";
  const auto folder = wholeMatch(path, "renderer/(.+)/[^/]*");

  for (const Captures& match : allMatches(text, kInclude)) {
    const std::string header = match[2];
    for (const auto& [library, locations] : kIncludedBy)
      if (("/" + header).find("/" + library) != std::string::npos &&
          std::ranges::none_of(locations, [&](const auto& l) { return path.starts_with(l); }))
        found.push_back(path + " includes " + header + ": only " + locations.front() + " may");
    if (!folder || match[1] == "<") continue;

    const std::string from = (*folder)[1], to = header.substr(0, header.rfind('/'));
    if (!kMayInclude.contains(from)) {
      found.push_back(path + ": renderer/" + from + " has no row in kMayInclude");
    } else if (header.find('/') == std::string::npos) {
      found.push_back(path + " includes " + header + ": write the path from renderer/");
    } else if (to != from && !kMayInclude.at(from).contains(to)) {
      found.push_back(path + " includes " + header + ": " + from + " may not include " + to);
    }
  }
  return found;
}

std::string contents(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(House, IncludeCheckFindsViolations) {
  const auto count = [](const char* path, const char* text) {
    return violations(path, text).size();
  };
  EXPECT_EQ(count("renderer/math/warp.h", "#include \"math/vec.h\"\n#include <cmath>\n"), 0u);
  EXPECT_EQ(count("renderer/math/warp.h", "#include \"image/image.h\"\n"), 1u);
  EXPECT_EQ(count("renderer/math/warp.h", "#pragma once\n  # include \"probe/probe.h\"\n"), 1u);
  EXPECT_EQ(count("renderer/math/warp.h", "#include \"vec.h\"\n"), 1u);
  EXPECT_EQ(count("renderer/attic/a.h", "#include \"math/vec.h\"\n"), 1u);
  EXPECT_EQ(count("renderer/lighting/a.cpp", "#include \"trace/tracer.h\"\n"), 1u);
  EXPECT_EQ(count("renderer/transport/a.cpp", "#include \"measure/error.h\"\n"), 1u);
  EXPECT_EQ(count("renderer/transport/a.cpp", "#include \"trace/tracer.h\"\n"), 0u);
  EXPECT_EQ(count("renderer/trace/a.cpp", "#include <embree3/rtcore.h>\n"), 0u);
  EXPECT_EQ(count("renderer/shading/a.cpp", "#include <embree4/rtcore.h>\n"), 1u);
  EXPECT_EQ(count("tests/a.cpp", "#include <OpenImageIO/imageio.h>\n"), 1u);
  EXPECT_EQ(count("renderer/image/io/exr_input.cpp", "#include <OpenEXR/ImfHeader.h>\n"), 0u);
  EXPECT_EQ(count("renderer/bake/a.cpp", "#include <png.h>\n"), 1u);
  EXPECT_EQ(count("renderer/bake/a.cpp", "#include \"image/io/write_image.h\"\n"), 0u);
  EXPECT_EQ(count("renderer/scene/gltf/mesh.cpp", "#include <tiny_gltf.h>\n"), 0u);
  EXPECT_EQ(count("renderer/scene/scene_file.h", "#include <toml++/toml.h>\n"), 1u);
  EXPECT_EQ(count("renderer/film/a.cpp", "#include <CLI/CLI.hpp>\n"), 1u);
  EXPECT_EQ(count("renderer/probe/a.cpp", "#include <Eigen/Core>\n"), 1u);
  EXPECT_EQ(count("tools/command/render.cpp", "#include <CLI/CLI.hpp>\n#include \"film/film.h\"\n"),
            1u);
  EXPECT_EQ(count("tools/command/command.cpp", "#include <CLI/CLI.hpp>\n"), 0u);
}

// The project's source and text files, relative to its folder, without generated folders.
std::vector<fs::path> projectFiles(const std::set<std::string>& extensions) {
  const fs::path root = kSourceDir;
  std::vector<fs::path> files;
  for (const char* folder :
       {".ci", "renderer", "python", "tools", "tests", "scenes", "probes", "docs"}) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
        files.push_back(entry.path().lexically_relative(root));
  }
  return files;
}

TEST(House, IncludesFollowTheTable) {
  const std::vector<fs::path> files = projectFiles({".h", ".cpp"});
  for (const fs::path& path : files)
    for (const auto& violation : violations(path.generic_string(), contents(kSourceDir / path)))
      ADD_FAILURE() << violation;
  EXPECT_GT(files.size(), 10u) << "the source tree was not found";
}

// Intervals, limits of time and checkpoints are measured by a clock that nobody sets
// (base/progress.h); a date is written by comparisons and into the headers of images alone.
// Permissions are those that the sources need, so that the table shows the folders as they are.
TEST(House, EveryPermissionIsUsed) {
  std::map<std::string, std::set<std::string>> used;
  std::set<std::string> usedLibraries;
  for (const fs::path& path : projectFiles({".h", ".cpp"})) {
    const auto folder = wholeMatch(path.generic_string(), "renderer/(.+)/[^/]*");
    for (const Captures& match :
         allMatches(contents(kSourceDir / path), R"(#\s*include\s*([<"])([^>"]+)[>"])")) {
      const std::string header = match[2];
      for (const auto& [library, locations] : kIncludedBy)
        if (("/" + header).find("/" + library) != std::string::npos)
          for (const std::string& location : locations)
            if (path.generic_string().starts_with(location))
              usedLibraries.insert(library + location);
      if (folder && match[1] == "\"" && header.find('/') != std::string::npos)
        used[(*folder)[1]].insert(header.substr(0, header.rfind('/')));
    }
  }
  for (const auto& [folder, permitted] : kMayInclude)
    for (const std::string& other : permitted)
      EXPECT_TRUE(used[folder].contains(other)) << folder << " does not include " << other;
  for (const auto& [library, locations] : kIncludedBy)
    for (const std::string& location : locations)
      EXPECT_TRUE(usedLibraries.contains(library + location)) << location << ": " << library;
}

TEST(House, ClockThatCanBeSetIsForDatesAndFilesAlone) {
  static const std::string kSettable =
      R"(system_clock|high_resolution_clock|file_clock|last_write_time|gettimeofday|)"
      R"(CLOCK_REALTIME|\btime\((nullptr|NULL|0|&))";
  for (const fs::path& path : projectFiles({".h", ".cpp"}))
    if (path.generic_string().starts_with("renderer/") &&
        path != "renderer/session/render_report.cpp" && path != "renderer/image/io/exr_rows.cpp" &&
        path != "renderer/base/file_stamps.cpp") {
      EXPECT_FALSE(containsMatch(contents(kSourceDir / path), kSettable)) << path;
    }
  EXPECT_TRUE(containsMatch(contents(kSourceDir / fs::path("renderer/session/render_report.cpp")),
                            kSettable));
}

// The library is a guest in its process: it prints nothing, ends nothing, takes no signals, moves
// no descriptors and changes nothing that all threads share. (Files of its own are opened by
// fopen(), open() and streams.)
TEST(House, LibraryLeavesItsProcessAlone) {
  static const std::string kForbidden =
      R"(\bstd::(cout|cerr|clog|signal|terminate|set_terminate|atexit|setlocale|locale::global)\b|)"
      R"(\b(stdout|stderr|STDOUT_FILENO|STDERR_FILENO|STDIN_FILENO)\b|fmt::(v)?print|)"
      R"(\b(v?f?printf|puts|putchar|fputs|perror|exit|_exit|_Exit|quick_exit|abort|dup|dup2|dup3|)"
      R"(freopen|sigaction|sigprocmask|pthread_sigmask|raise|kill|setlocale|setenv|unsetenv|)"
      R"(putenv|chdir|umask|srand|system|popen|fork|atexit)\s*\()";
  for (const char* line : {"std::cerr << x", "fmt::print(\"\")", "dup2(a, 2)", "std::exit(1)",
                           "printf (x)", "write(STDERR_FILENO, x, 1)"})
    EXPECT_TRUE(containsMatch(line, kForbidden)) << line;
  for (const char* line :
       {"std::snprintf(x)", "row.killed()", "outputs(", "system_error(", "exits("})
    EXPECT_FALSE(containsMatch(line, kForbidden)) << line;
  int files = 0;
  for (const fs::path& path : projectFiles({".h", ".cpp"})) {
    if (!path.generic_string().starts_with("renderer/")) continue;
    EXPECT_FALSE(containsMatch(contents(kSourceDir / path), kForbidden)) << path;
    ++files;
  }
  EXPECT_GT(files, 400);
}

TEST(House, SourcesStartWithTheirLicence) {
  static const std::string kSpdx =
      "^(#!.*\n)?(//|#|\\.\\\\\"|<!--) SPDX-License-Identifier: Apache-2\\.0( -->)?\n";
  std::vector<fs::path> files =
      projectFiles({".h", ".cpp", ".in", ".cmake", ".sh", ".py", ".js", ".bash", ".fish", ".1"});
  files.insert(files.end(), {"CMakeLists.txt", "pyproject.toml", "tests/consumer/CMakeLists.txt",
                             ".ci/run", "Dockerfile"});
  for (const fs::path& path : files) {
    EXPECT_TRUE(containsMatch(contents(kSourceDir / path), kSpdx))
        << path << ": the first line (after #!) must be SPDX-License-Identifier: Apache-2.0";
  }
}

// Files of tests are compiled together, with the same short names in many
// (tools/cmake/unity.cmake). Those with a header help several tests.
TEST(House, EachFileOfTestsHasANamespaceOfItsName) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(kSourceDir / fs::path("tests"))) {
    const fs::path& path = entry.path();
    if (!path.filename().string().ends_with("_test.cpp")) continue;
    if (fs::exists(fs::path(path).replace_extension(".h"))) continue;
    const std::string own = "\nnamespace (chromeball::)?" + path.stem().string() + " \\{\n";
    EXPECT_TRUE(containsMatch(contents(path), own)) << path;
    ++files;
  }
  EXPECT_GT(files, 100);
}

TEST(House, TopLevelHasOnlyListedFiles) {
  const std::set<std::string> allowed = {"renderer",        "tools",        "tests",
                                         "scenes",          "probes",       "docs",
                                         "CMakeLists.txt",  "Dockerfile",   "README.md",
                                         "LICENSE",         "CHANGELOG.md", "CMakePresets.json",
                                         "CONTRIBUTING.md", "python",       "pyproject.toml"};
  for (const auto& entry : fs::directory_iterator(kSourceDir)) {
    const std::string name = entry.path().filename().string();
    const bool generated = entry.is_directory() && (name.starts_with("build") || name == "out");
    if (name.starts_with('.') || generated) continue;
    EXPECT_TRUE(allowed.contains(name)) << name << " is not in the list of the top level";
  }
}

}  // namespace
}  // namespace house_test
