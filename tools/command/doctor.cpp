// SPDX-License-Identifier: Apache-2.0
// chromeball doctor
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/text.h"
#include "commands.h"
#include "image/io/exr_metadata.h"
#include "image/io/imageio_module.h"
#include "json_values.h"
#include "session/render_report.h"
#include "trace/accel.h"

namespace chromeball {
namespace {

struct DoctorArguments {
  bool json = false;
};

struct VectorUnit {
  const char* name;
  bool isUsed, isThere;  // by this build, in this machine
};

std::vector<VectorUnit> vectorUnits() {
#ifdef __AVX2__
  constexpr bool kAvx2 = true;
#else
  constexpr bool kAvx2 = false;
#endif
#ifdef __AVX512F__
  constexpr bool kAvx512 = true;
#else
  constexpr bool kAvx512 = false;
#endif
  return {{"AVX2", kAvx2, __builtin_cpu_supports("avx2") != 0},
          {"AVX-512", kAvx512, __builtin_cpu_supports("avx512f") != 0}};
}

struct Examination {
  Machine machine = thisMachine();
  EmbreeVersion embree = embreeVersion();
  ModuleState images = imageioModuleState();
  MemoryLimits memory = memoryLimits();
  std::vector<VectorUnit> units = vectorUnits();
  std::string temporaryFolder;       // empty: there is none
  std::vector<std::string> missing;  // each with what it means
};

Examination examine() {
  constexpr double kLittleMemory = 1e9;
  Examination found;
  std::error_code error;
  found.temporaryFolder = std::filesystem::temp_directory_path(error).string();
  if (found.temporaryFolder.empty())
    found.missing.push_back("a folder for temporary files ($TMPDIR), which --texture-memory needs");
  if (memoryBudget() < kLittleMemory)
    found.missing.push_back(
        fmt::format("memory: renders may use {:.2g} GB, too little for large probes and models",
                    1e-9 * memoryBudget()));
  for (const VectorUnit& unit : found.units)
    if (unit.isUsed && !unit.isThere)
      found.missing.push_back(fmt::format("{}, for which this program was built", unit.name));
  return found;
}

JsonValue toJson(const Examination& f) {
  JsonValue units = JsonValue::object();
  for (const VectorUnit& unit : f.units)
    units[unit.name] = {{"used", unit.isUsed}, {"there", unit.isThere}};
  return {{"versions",
           {{"chromeball", CHROMEBALL_VERSION},
            {"compiler", f.machine.compiler},
            {"embree", f.embree.version},
            {"openexr", exrVersion()},
            {"openimageio", f.images.version.empty() ? JsonValue() : JsonValue(f.images.version)},
            {"tbb", tbbVersion()},
            {"gltf", "2.0"}}},
          {"system", f.machine.system},
          {"processor", f.machine.processor},
          {"cores", std::thread::hardware_concurrency()},
          {"threads", f.machine.threads},
          {"vector_units", units},
          {"embree_lanes", f.embree.lanes},
          {"memory",
           {{"machine", f.memory.machine},
            {"address_space", orNull(f.memory.addressSpace)},
            {"control_group", orNull(f.memory.controlGroup)},
            {"for_renders", memoryBudget()}}},
          {"temporary_folder", f.temporaryFolder},
          {"missing", f.missing}};
}

void printFinding(std::string_view subject, const std::string& text) {
  fmt::print("{:<16} {}\n", subject, printable(text));
}

std::string gigabytes(double bytes) {
  return std::isfinite(bytes) ? fmt::format("{:.3g} GB", 1e-9 * bytes) : "none";
}

std::string describeUnit(const VectorUnit& unit) {
  return fmt::format("{} {}{}", unit.name, unit.isUsed ? "used" : "not used",
                     unit.isThere == unit.isUsed ? ""
                     : unit.isThere              ? ", though the machine has it"
                                                 : ", which the machine lacks");
}

void print(const Examination& f) {
  printFinding("chromeball", CHROMEBALL_VERSION ", by " + f.machine.compiler);
  printFinding("Embree", fmt::format("{}, {} rays at once", f.embree.version, f.embree.lanes));
  printFinding("OpenEXR", exrVersion());
  printFinding("OpenImageIO", f.images.version.empty()
                                  ? "none: TIFF files are not read (" + f.images.problem + ")"
                                  : f.images.version + ", for TIFF");
  printFinding("oneTBB", tbbVersion());
  printFinding("glTF", "2.0");
  printFinding("system", f.machine.system);
  printFinding("processor", f.machine.processor);
  printFinding("threads",
               fmt::format("{} of {}", f.machine.threads, std::thread::hardware_concurrency()));
  std::vector<std::string> units;
  for (const VectorUnit& unit : f.units) units.push_back(describeUnit(unit));
  printFinding("vector units", fmt::format("{}", fmt::join(units, "; ")));
  printFinding("memory", fmt::format("{}; limits: address space {}, control group {}",
                                     gigabytes(f.memory.machine), gigabytes(f.memory.addressSpace),
                                     gigabytes(f.memory.controlGroup)));
  printFinding("for renders", gigabytes(memoryBudget()) + ", unless --memory says otherwise");
  printFinding("temporary files", f.temporaryFolder.empty() ? "nowhere" : f.temporaryFolder);
}

void run(const DoctorArguments& arguments) {
  const Examination found = examine();
  if (arguments.json)
    printJson(toJson(found));
  else
    print(found);
  if (!found.missing.empty()) throwRun("missing: {}", fmt::join(found.missing, "; "));
  if (!arguments.json)
    fmt::print("nothing{} is missing\n", found.images.version.empty() ? " else" : "");
}

}  // namespace

void addDoctorCommand(Command app) {
  auto [command, a] = app.addCommand<DoctorArguments>(
      "doctor", "Show versions, processor and memory, and whether anything is missing.", run);
  command.addFlag("--json", a.json, "print JSON");
  command.footer(
      "Ends with status 1, and says what is missing and what that means, unless all is there.\n");
}

}  // namespace chromeball
