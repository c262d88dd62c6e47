// SPDX-License-Identifier: Apache-2.0
// The commands of README.md and of the pages parse, and the lines that the page about
// troubles quotes are those of the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "paths.h"
#include "regular_expression.h"
#include "run_command.h"

namespace chromeball::docs_commands_test {
namespace {

using Words = std::vector<std::string>;

std::string projectFile(const std::string& name) {
  return fileContents(std::string(kSourceDir) + "/" + name);
}

// Words as a shell has them that knows spaces, quotes, and variables, which become 1.
Words wordsOf(const std::string& line) {
  Words words;
  std::string word;
  char quote = 0;
  for (size_t i = 0; i <= line.size(); ++i) {
    const char c = i < line.size() ? line[i] : ' ';
    if (quote == 0 && (c == ' ' || c == ';')) {
      if (!word.empty()) words.push_back(word);
      word.clear();
      if (c == ';') break;
    } else if (c == quote || (quote == 0 && (c == '"' || c == '\''))) {
      quote = quote == 0 ? c : '\0';
    } else {
      word += c;
    }
  }
  const auto end = std::ranges::find_if(
      words, [](const std::string& w) { return w == "&&" || w == "|" || w == "#" || w == ">"; });
  words.erase(end, words.end());
  for (std::string& w : words) w = replaceMatches(w, "\\$[a-z]+", "1");
  return words;
}

// The arguments of each command of this program in the blocks of code.
std::vector<Words> commandsIn(const std::string& page) {
  std::vector<Words> commands;
  const std::string joined = replaceMatches(page, " \\\\\n *", " ");
  std::istringstream lines(joined);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("    ")) continue;
    for (const Captures& command : allMatches(line, "(?:^|&& | )(?:build/)?chromeball ([^&]*)")) {
      Words words = wordsOf(command[1]);
      if (!words.empty() && std::isalpha(words[0][0])) commands.push_back(words);
    }
  }
  return commands;
}

void expectParsed(const std::string& page, size_t least) {
  const std::vector<Words> commands = commandsIn(projectFile(page));
  EXPECT_GE(commands.size(), least) << page;
  for (Words words : commands) {
    std::string line;
    for (const std::string& word : words) line += " " + word;
    words.push_back("--no-such-option");
    const std::string error = runCommand(words).error;
    EXPECT_EQ(error.find("chromeball: unknown option `--no-such-option`"), 0u)
        << page << ":" << line << "\n"
        << error;
  }
}

TEST(SlowDocsCommands, Parse) {
  expectParsed("README.md", 15);
  expectParsed("docs/recipes.md", 15);
  expectParsed("docs/compositing-apps.md", 2);
  for (const auto& entry : std::filesystem::directory_iterator(std::string(kSourceDir) + "/docs"))
    if (entry.path().extension() == ".md")
      expectParsed("docs/" + entry.path().filename().string(), 0);
}

// All string literals of the program, adjacent ones joined.
std::string literals() {
  namespace fs = std::filesystem;
  std::string all;
  for (const char* folder : {"/renderer", "/tools/command"})
    for (const auto& entry : fs::recursive_directory_iterator(std::string(kSourceDir) + folder))
      if (entry.path().extension() == ".cpp")
        all += replaceMatches(fileContents(entry.path()), "\"\\s*\n\\s*\"", "");
  return all;
}

// In the tables with a column `line`, whose first cells are code.
TEST(SlowDocsCommands, TroublesQuoteTheProgram) {
  const std::string page = projectFile("docs/troubleshooting.md"), program = literals();
  int quoted = 0;
  for (const Captures& row : allMatches(page, "\n\\| `([^|]*)` \\|")) {
    std::istringstream parts(
        replaceMatches(replaceMatches(row[1], "` or `", "\n"), "\\.\\.\\.", "\n"));
    for (std::string part; std::getline(parts, part);) {
      part = replaceMatches(part, "^%?[ ;]*| $|`.*", "");
      if (part.size() < 6) continue;
      ++quoted;
      EXPECT_NE(program.find(part), std::string::npos) << part;
    }
  }
  EXPECT_GT(quoted, 12);
}

}  // namespace
}  // namespace chromeball::docs_commands_test
