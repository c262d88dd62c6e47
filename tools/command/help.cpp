// SPDX-License-Identifier: Apache-2.0
#include "help.h"

#include <fmt/format.h>

namespace chromeball {

std::string HelpFormatter::make_option_name(const CLI::Option* option, bool isPositional) const {
  if (isPositional) return option->get_name(true);
  std::vector<std::string> names;
  for (const std::string& letter : option->get_snames()) names.push_back("-" + letter);
  if (!option->get_lnames().empty()) names.push_back("--" + option->get_lnames().front());
  return fmt::format("{}", fmt::join(names, ","));
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  const auto found = brief_.find(app);
  if (found == brief_.end() || showsAll_) return Formatter::make_help(app, name, mode);
  const auto& [options, examples] = found->second;
  std::vector<const CLI::Option*> common;
  for (const std::string& option : options)
    if (const CLI::Option* known = app->get_option_no_throw("--" + option)) common.push_back(known);
  const std::vector<const CLI::Option*> own = app->get_options([](const CLI::Option* option) {
    return option->nonpositional() && option->get_group() == "Options";
  });
  return make_description(app) + make_usage(app, name) +
         (examples.empty() ? "" : "\nExamples:\n" + examples) + make_positionals(app) +
         make_group("Options", false, own) + make_group("Common options", false, common) +
         fmt::format("\nAll options, by group: chromeball {} --help all\n", app->get_name());
}

HelpFormatter& helpOf(const CLI::App& command) {
  return dynamic_cast<HelpFormatter&>(*command.get_formatter());
}

}  // namespace chromeball
