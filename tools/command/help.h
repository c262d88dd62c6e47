// SPDX-License-Identifier: Apache-2.0
// The text of --help, and the brief one of commands that have many options.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace chromeball {

// The options that a brief help shows, in this order, beside those in no group of their own.
struct BriefHelp {
  std::vector<std::string> options;
  std::string examples;
};

// Of an option the short name and the first long one; others are accepted, and not shown.
class HelpFormatter : public CLI::Formatter {
 public:
  void shorten(const CLI::App& command, BriefHelp help) { brief_[&command] = std::move(help); }
  void showAll() { showsAll_ = true; }

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_option_name(const CLI::Option* option, bool isPositional) const override;

 private:
  std::map<const CLI::App*, BriefHelp> brief_;
  bool showsAll_ = false;
};

// The formatter that a command has from the program.
HelpFormatter& helpOf(const CLI::App& command);

}  // namespace chromeball
