// The command line: finds the subcommand, and turns every failure into one line and an exit status.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "commands.h"
#include "math/error.h"
#include "math/suggest.h"

namespace {

using namespace chromeball;

constexpr int kFailed = 1, kBadInput = 2, kInterrupted = 130;

int report(int status, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::fflush(stdout);
  fmt::print(stderr, "chromeball: {}\n", message);
  return status;
}

// The subcommands that were named, outermost first; at least the program itself.
std::vector<const CLI::App*> namedCommands(const CLI::App& app) {
  std::vector<const CLI::App*> commands{&app};
  while (!commands.back()->get_subcommands().empty())
    commands.push_back(commands.back()->get_subcommands().front());
  return commands;
}

// CLI11's error as one of ours; where a word was not understood, with the nearest that would be.
std::string describe(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<const CLI::App*> commands = namedCommands(app);
  const CLI::App& command = *commands.back();
  std::string help = "see `";
  for (const CLI::App* named : commands) help += named->get_name() + " ";
  help += "--help`";
  const std::vector<std::string> unknown = app.remaining(true);
  if (unknown.empty()) return fmt::format("{}; {}", error.what(), help);

  const std::string& word = unknown.front();
  const bool isOption = word.starts_with("-");
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      if (isOption) names.push_back("--" + name);
  for (const CLI::App* subcommand : command.get_subcommands(nullptr))
    if (!isOption) names.push_back(subcommand->get_name());
  const std::vector<std::string_view> known(names.begin(), names.end());
  return fmt::format("unknown {} `{}`; {}",
                     isOption        ? "option"
                     : known.empty() ? "argument"
                                     : "command",
                     word,
                     known.empty() ? help : didYouMean(word.substr(0, word.find('=')), known));
}

int run(int argc, char** argv) {
  CLI::App app{"Renders glTF scenes lit by HDR light probes.", "chromeball"};
  app.set_version_flag("--version", "chromeball " CHROMEBALL_VERSION);
  app.require_subcommand(1);
  addRenderCommand(app);
  addCompareCommand(app);
  addProbeCommand(app);
  addImageCommand(app);
  addLightsCommand(app);
  addLightsErrorCommand(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return report(kBadInput, describe(app, error));
  }
  if (std::fflush(stdout) != 0) throwRun("standard output: {}", std::strerror(errno));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is a write that fails, no more
  try {
    return run(argc, argv);
  } catch (const InputError& error) {
    return report(kBadInput, error.what());
  } catch (const Interrupted& error) {
    return report(kInterrupted, error.what());
  } catch (const std::bad_alloc&) {
    return report(kFailed, "out of memory");
  } catch (const std::exception& error) {
    return report(kFailed, error.what());
  }
}
