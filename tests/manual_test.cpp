// SPDX-License-Identifier: Apache-2.0
// The man page and the completion files name every command and option that --help names.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "paths.h"
#include "regular_expression.h"
#include "run_command.h"

namespace manual_test {
namespace {

using Words = std::vector<std::string>;

constexpr const char* kRemedy = "run tools/scripts/manual.py";

std::string joined(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// Command ("probe info"; "" for the program) -> its subcommands' names and its long options.
struct Names {
  Words subcommands, options;
};

void readHelp(const Words& command, std::map<std::string, Names>& commands) {
  Words arguments = command;
  arguments.insert(arguments.end(), {"--help", "all"});
  std::istringstream help(runCommand(arguments).out);
  Names& names = commands[joined(command)];
  std::string section;
  for (std::string line; std::getline(help, line);) {
    if (!line.empty() && line[0] != ' ') section = line;
    if (const auto option = wholeMatch(line, "  (?:-\\w,)?(--[a-z0-9-]+).*"))
      names.options.push_back((*option)[1]);
    else if (const auto name = wholeMatch(line, "  ([a-z-]+) .*");
             name && section == "Subcommands:")
      names.subcommands.push_back((*name)[1]);
  }
  for (const std::string& subcommand : names.subcommands) {
    Words words = command;
    words.push_back(subcommand);
    readHelp(words, commands);
  }
}

const std::map<std::string, Names>& allCommands() {
  static const std::map<std::string, Names> kCommands = [] {
    std::map<std::string, Names> commands;
    readHelp({}, commands);
    return commands;
  }();
  return kCommands;
}

std::string projectFile(const std::string& name) {
  return fileContents(std::string(kSourceDir) + "/" + name);
}

// The part of `text` from `begin` to the next `end`; "" where `begin` is missing.
std::string part(const std::string& text, const std::string& begin, const std::string& end) {
  const size_t from = text.find(begin);
  if (from == std::string::npos) return "";
  const size_t to = text.find(end, from + begin.size());
  return text.substr(from, to == std::string::npos ? to : to - from);
}

bool hasWord(const std::string& text, const std::string& word) {
  return containsMatch(text, "(^|[^\\w-])" + word + "($|[^\\w-])");
}

TEST(SlowManual, HelpIsParsed) {
  const auto& commands = allCommands();
  ASSERT_TRUE(commands.contains("probe info"));
  EXPECT_TRUE(hasWord(joined(commands.at("probe info").options), "--json"));
  EXPECT_TRUE(hasWord(joined(commands.at("render").options), "--output"));
  EXPECT_TRUE(hasWord("a --json b", "--json"));
  EXPECT_FALSE(hasWord("--json-lines", "--json"));
}

TEST(SlowManual, PageDescribesEveryCommandAndOption) {
  std::string page = replaceMatches(projectFile("docs/chromeball.1"), "\\\\-", "-");
  page = replaceMatches(page, "(\\.SS [^\n]*)", "$1 ");  // also after a command without arguments
  for (const auto& [command, names] : allCommands()) {
    if (command.empty() || !names.subcommands.empty()) continue;
    const std::string section = part(page, ".SS chromeball " + command + " ", ".SS ");
    EXPECT_NE(section, "") << "no section on `" << command << "`; " << kRemedy;
    for (const std::string& option : names.options) {
      if (option == "--help") continue;  // described once, for all
      EXPECT_NE(section.find("\\fB" + option + "\\fR"), std::string::npos)
          << command << " " << option << ": " << kRemedy;
    }
  }
}

TEST(Manual, BashAndZshCompleteEveryCommandAndOption) {
  for (const char* file : {"tools/completion/chromeball.bash", "tools/completion/_chromeball"}) {
    const std::string completion = projectFile(file);
    for (const auto& [command, names] : allCommands()) {
      const std::string section = part(completion, "\n    '" + command + "')\n", " ;;\n");
      EXPECT_NE(section, "") << file << ": no section on `" << command << "`; " << kRemedy;
      for (const Words& words : {names.subcommands, names.options})
        for (const std::string& word : words)
          EXPECT_TRUE(hasWord(section, word))
              << file << ": " << command << " " << word << ": " << kRemedy;
    }
  }
}

TEST(Manual, FishCompletesEveryCommandAndOption) {
  const std::string completion = projectFile("tools/completion/chromeball.fish");
  for (const auto& [command, names] : allCommands()) {
    std::string condition;
    for (std::istringstream words(command); !words.eof() && !command.empty();) {
      std::string word;
      words >> word;
      condition += (condition.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + word);
    }
    if (command.empty()) condition = "__fish_use_subcommand";
    std::string lines;
    std::istringstream file(completion);
    for (std::string line; std::getline(file, line);)
      if (line.starts_with("complete -c chromeball -n '" + condition + "'") ||
          line.starts_with("complete -c chromeball -n '" + condition + "; and not "))
        lines += line + "\n";
    for (const std::string& word : names.subcommands)
      EXPECT_NE(lines.find("-a " + word + " "), std::string::npos) << command << " " << word;
    for (const std::string& option : names.options)
      EXPECT_NE(lines.find("-l " + option.substr(2) + " "), std::string::npos)
          << command << " " << option << ": " << kRemedy;
  }
}

}  // namespace
}  // namespace manual_test
