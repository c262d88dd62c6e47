// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <memory>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "commands.h"
#include "front/synonyms.h"
#include "help.h"
#include "messages.h"
#include "scene_options.h"
#include "session/memory_estimate.h"
#include "session/render_report.h"

namespace chromeball {
namespace {

constexpr int kFailed = 1, kBadInput = 2, kInterrupted = 130;

int report(int status, const std::string& message) {
  std::fflush(stdout);
  note(message);
  return status;
}

// The program and the subcommands given, outermost first.
std::vector<const CLI::App*> namedCommands(const CLI::App& app) {
  std::vector<const CLI::App*> commands{&app};
  while (!commands.back()->get_subcommands().empty())
    commands.push_back(commands.back()->get_subcommands().front());
  return commands;
}

// "--samples: `many` is not a whole number" for CLI11's "Could not convert: --samples = many".
std::string describeConversion(const CLI::App& command, const std::string& error) {
  const std::string_view kBegin = "Could not convert: ", kEquals = " = ";
  const size_t equals = error.find(kEquals);
  if (!error.starts_with(kBegin) || equals == std::string::npos) return "";
  const std::string name = error.substr(kBegin.size(), equals - kBegin.size());
  const CLI::Option* option = command.get_option_no_throw(name);
  const std::string type = option ? option->get_type_name() : "";
  return fmt::format("{}: `{}` is not {}", name, error.substr(equals + kEquals.size()),
                     type == "INT"    ? "a whole number"
                     : type == "UINT" ? "a whole number, 0 or more"
                                      : "a number");
}

// "--samples: needs a value, N" for CLI11's "--samples: 1 required N missing".
std::string describeMismatch(const std::string& error) {
  const std::string_view kNone = ": 1 required ", kMissing = " missing";
  const size_t none = error.find(kNone);
  if (none == std::string::npos || !error.ends_with(kMissing)) return "";
  const size_t argument = none + kNone.size();
  return fmt::format("{}: needs a value, {}", error.substr(0, none),
                     error.substr(argument, error.size() - kMissing.size() - argument));
}

// The command's option that others call so, with its argument if it is a setting; empty if unknown.
std::string optionCalledSo(const std::string& word, const CLI::App& command) {
  const auto isOption = [&](const std::string& name) {
    return command.get_option_no_throw("--" + name) != nullptr;
  };
  const Setting* setting = settingCalled(word);
  if (setting && isOption(setting->option)) return optionText(*setting);
  const std::string other(optionCalled(word));
  return !other.empty() && isOption(other) ? "--" + other : "";
}

// Which option of the command the unknown one, "--spp", may mean; where it is none, what to do.
std::string hintOn(const std::string& option, const CLI::App& command) {
  std::vector<std::string> shown;  // names that the help shows
  std::map<std::string, std::string> all;
  for (const CLI::Option* known : command.get_options())
    if (const auto& names = known->get_lnames(); !names.empty()) {
      shown.push_back("--" + names.front());
      for (const std::string& name : names) all["--" + name] = shown.back();
    }
  std::vector<std::string_view> names;
  for (const auto& [name, first] : all) names.push_back(name);
  if (const std::string same(sameName(option, names)); !same.empty())
    return fmt::format("did you mean `{}`?", all.at(same));
  if (const std::string ours = optionCalledSo(option, command); !ours.empty())
    return fmt::format("did you mean `{}`?", ours);
  if (const auto place = placeOf(option); !place.empty() && all.contains("--probe"))
    return std::string(place);
  const std::string nearest(nearestName(option, names));
  if (nearest.empty()) return didYouMean(option, {shown.begin(), shown.end()});
  return fmt::format("did you mean `{}`?", all.at(nearest));
}

// The text of a flag's value that a word stands for, "false" for "off"; empty if it is none.
std::string_view valueOfFlag(std::string_view word) {
  constexpr std::array<std::string_view, 4> kTrue = {"true", "on", "yes", "1"},
                                            kFalse = {"false", "off", "no", "0"};
  const std::string name = lowerCase(word);
  if (std::ranges::count(kTrue, name) > 0) return "true";
  return std::ranges::count(kFalse, name) > 0 ? "false" : "";
}

// What to say about `--ground 0.5`, where the value of an option may be left out, or `--denoise
// off`; empty if no such option of the command is among the words.
std::string onValueWithoutEquals(const CLI::App& command, const std::vector<std::string>& words) {
  const auto needsEquals = [](const Setting& setting, const std::string& given) {
    return fmt::format("--{}: needs `=` before a value; did you mean `{}`?", setting.option, given);
  };
  for (const Setting& setting : settingTable())
    for (size_t i = 1; i < words.size(); ++i) {
      const std::string option = "--" + setting.option;
      if (words[i - 1] != option || !command.get_option_no_throw(option)) continue;
      double number = 0;
      if (!setting.bare.empty() && toNumber(words[i], number))
        return needsEquals(setting, optionText(setting, words[i]));
      const std::string_view flag = valueOfFlag(words[i]);
      if (setting.type == SettingType::Flag && !flag.empty())
        return needsEquals(setting, fmt::format("--{}={}", setting.option, flag));
    }
  return "";
}

// The command that reads a file which was given in place of the name of a command below `group`;
// empty if the word is no such file.
std::string commandForFile(const std::string& group, const std::string& word) {
  constexpr std::array kScenes = {".toml", ".gltf", ".glb"};
  constexpr std::array kImages = {".hdr",  ".exr",  ".pfm", ".png",  ".jpg",
                                  ".jpeg", ".webp", ".tif", ".tiff", ".pic"};
  const std::string extension = lowerExtension(word);
  const bool isScene = std::ranges::count(kScenes, extension) > 0;
  if (isScene && group == "chromeball") return "chromeball render " + word;
  if (std::ranges::count(kImages, extension) == 0) return "";
  if (group == "image") return fmt::format("chromeball image view {} OUT.png", word);
  return group == "chromeball" || group == "probe" ? "chromeball probe info " + word : "";
}

// Rewrites an error message of CLI11 about these words; for an unknown one, adds the nearest known.
std::string describe(const CLI::App& app, const CLI::ParseError& error,
                     const std::vector<std::string>& words) {
  const std::vector<const CLI::App*> commands = namedCommands(app);
  const CLI::App& command = *commands.back();
  std::string help = "see `";
  for (const CLI::App* named : commands) help += named->get_name() + " ";
  help += "--help`";
  const std::vector<std::string> unknown = app.remaining(true);
  if (error.get_exit_code() == int(CLI::ExitCodes::ConversionError))
    if (const std::string message = describeConversion(command, error.what()); !message.empty())
      return message;
  if (error.get_exit_code() == int(CLI::ExitCodes::ArgumentMismatch))
    if (const std::string message = describeMismatch(error.what()); !message.empty())
      return message;
  if (unknown.empty()) return fmt::format("{}; {}", error.what(), help);

  if (const std::string message = onValueWithoutEquals(command, words); !message.empty())
    return message;
  const std::string& word = unknown.front();
  const auto owner = std::ranges::find_if(  // `prob info`: it is none of `info`
      commands, [](const CLI::App* named) { return !named->remaining(false).empty(); });
  const CLI::App& where = owner == commands.end() ? command : **owner;
  if (word.starts_with("-")) {
    const std::string option = word.substr(0, word.find('='));
    return fmt::format("unknown option `{}`; {}", option, hintOn(option, where));
  }
  if (const std::string better = commandForFile(where.get_name(), word); !better.empty())
    return fmt::format("unknown command `{}`; did you mean `{}`?", word, better);
  std::vector<std::string> names;
  for (const CLI::App* subcommand : where.get_subcommands(nullptr))
    names.push_back(subcommand->get_name());
  return fmt::format("unknown {} `{}`; {}", names.empty() ? "argument" : "command", word,
                     names.empty() ? help : didYouMean(word, {names.begin(), names.end()}));
}

// Without it the first file that is opened would get the number of a closed standard stream, and
// what is printed would be written into it. Reading and writing fail as they do when it is closed.
void occupyClosedStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0)
      open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);  // gets the lowest number
}

// An earlier write may have failed, after which nothing is left to flush.
void finishOutput() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    throwRun("standard output: {}", std::strerror(errno));
}

// --progress and --quiet for the commands below `app` that write files.
void addVerbosity(CLI::App& app) {
  constexpr std::array kReaders = {"info", "reflectivity", "doctor", "reference"};
  for (CLI::App* command : app.get_subcommands(nullptr)) {
    if (!command->get_subcommands(nullptr).empty()) {
      addVerbosity(*command);
    } else if (std::ranges::count(kReaders, command->get_name()) == 0) {
      command->add_flag("--progress", verbosity().progress,
                        "show the progress bar also if standard error is not a terminal");
      command->add_flag("--quiet", verbosity().quiet,
                        "print only warnings and errors, and JSON that was asked for");
    }
  }
}

// Whether the words ask for the whole help.
bool asksForAll(int argc, char** argv) {
  const std::vector<std::string_view> words(argv, argv + argc);
  const auto help = std::ranges::find_if(
      words, [](std::string_view word) { return word == "--help" || word == "-h"; });
  return help != words.end() && help + 1 != words.end() && help[1] == "all";
}

void addCommands(Command app, std::initializer_list<void (*)(Command)> adders) {
  for (const auto add : adders) add(app);
}

int run(int argc, char** argv) {
  CLI::App app{"Renders glTF scenes lit by HDR light probes.", "chromeball"};
  const auto help = std::make_shared<HelpFormatter>();
  app.formatter(help);
  app.set_help_flag("-h,--help", "Print this help and exit; `--help all`: with all options");
  app.set_version_flag("--version", "chromeball " CHROMEBALL_VERSION);
  app.require_subcommand(1);
  Command command(app);
  addCommands(command, {addRenderCommand, addMergeCommand, addCompareCommand, addBakeCommand,
                        addBasisCommand, addRelightCommand});
  addCommands(
      command.addCommand("probe", "Inspect, convert and make light probes.").requiresCommand(),
      {addProbeInfoCommand, addProbeConvertCommand, addProbeConvolveCommand,
       addProbeAssembleCommand, addProbeReflectivityCommand, addProbeSynthCommand,
       addProbeEditCommand, addProbeMergeCommand, addProbeSunCommand, addProbeSplitCommand,
       addProbeAddSunCommand, addProbeAlignCommand, addProbeStitchCommand, addProbeCropCommand,
       addProbeSpheresCommand, addProbeIrradianceCommand, addProbeRaysCommand,
       addProbePlotCommand});
  addCommands(
      command.addCommand("image", "View and compare images.").requiresCommand(),
      {addImageDenoiseCommand, addImageDevelopCommand, addImageDivideCommand, addImageErrorCommand,
       addImageFlatFieldCommand, addImageRelightCommand, addImageViewCommand});
  addCommands(command, {addCameraCommand, addLightsCommand, addLightsErrorCommand, addInfoCommand,
                        addDoctorCommand, addReferenceCommand});
  addVerbosity(app);
  if (asksForAll(argc, argv)) help->showAll();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0)
      return report(kBadInput, describe(app, error, {argv, argv + argc}));
    app.exit(error);  // prints --help or --version
  }
  finishOutput();
  return 0;
}

// Whether --memory limits what the command needs. (relight has it for stages, which it reads in
// parts, but not for models.)
bool hasMemoryLimit(std::string_view command) {
  constexpr std::array kCommands = {"render", "compare", "bake", "basis"};
  return std::ranges::find(kCommands, command) != kCommands.end();
}

}  // namespace

int runCommandLine(int argc, char** argv) {
  occupyClosedStreams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the size limit is a failed write
  try {
    return run(argc, argv);
  } catch (const InputError& error) {
    return report(kBadInput, error.what() + inWords(error.remedy));
  } catch (const Interrupted& error) {
    return report(kInterrupted, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return report(kBadInput, fmt::format("{}: {}", error.path1().string(), error.code().message()));
  } catch (const std::bad_alloc&) {
    const std::string had =
        fmt::format("out of memory: had {:.2g} GB", 1e-9 * double(peakMemoryBytes()));
    return report(kFailed, hasMemoryLimit(argv[1])
                               ? fmt::format("{}; see --memory, whose default here is {:.2g} GB",
                                             had, 1e-9 * memoryBudget())
                               : had);
  } catch (const std::exception& error) {
    return report(kFailed, error.what());
  }
}

}  // namespace chromeball
