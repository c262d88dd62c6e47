// SPDX-License-Identifier: Apache-2.0
#include "command.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>

namespace chromeball {

Option Option::required() { return Option(option_->required()); }
Option Option::excludes(const Option& other) { return Option(option_->excludes(other.option_)); }
Option Option::excludes(const std::string& name) { return Option(option_->excludes(name)); }
Option Option::inRange(int least, int most) {
  return Option(option_->check(CLI::Range(least, most)));
}
Option Option::delimiter(char separator) { return Option(option_->delimiter(separator)); }
Option Option::onePerName() { return Option(option_->allow_extra_args(false)); }
Option Option::takesAll() {
  return Option(option_->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll));
}
Option Option::words(int count) { return Option(option_->expected(count)); }
Option Option::showsDefault() { return Option(option_->capture_default_str()); }
Option Option::typeName(const std::string& name) { return Option(option_->type_name(name)); }
Option Option::group(const std::string& title) { return Option(option_->group(title)); }

Command Command::addCommand(const std::string& name, const std::string& help) {
  return Command(*app_->add_subcommand(name, help));
}

template <class T>
Option Command::addOption(const std::string& names, T& value, const std::string& help) {
  return Option(app_->add_option(names, value, help));
}
template Option Command::addOption(const std::string&, std::string&, const std::string&);
template Option Command::addOption(const std::string&, std::optional<std::string>&,
                                   const std::string&);
template Option Command::addOption(const std::string&, std::vector<std::string>&,
                                   const std::string&);
template Option Command::addOption(const std::string&, float&, const std::string&);
template Option Command::addOption(const std::string&, double&, const std::string&);
template Option Command::addOption(const std::string&, std::optional<double>&, const std::string&);
template Option Command::addOption(const std::string&, std::vector<double>&, const std::string&);
template Option Command::addOption(const std::string&, std::optional<int>&, const std::string&);
template Option Command::addOption(const std::string&, std::optional<int64_t>&, const std::string&);
template Option Command::addOption(const std::string&, std::optional<uint64_t>&,
                                   const std::string&);
template Option Command::addOption(const std::string&, int&, const std::string&);
template Option Command::addOption(const std::string&, std::vector<int>&, const std::string&);

Option Command::addFlag(const std::string& names, bool& value, const std::string& help) {
  return Option(app_->add_flag(names, value, help));
}

Option Command::addParsedOption(const std::string& names,
                                const std::function<void(const Words&)>& set,
                                const std::string& help) {
  const auto take = [set](const CLI::results_t& words) {
    set(words);
    return true;
  };
  return Option(app_->add_option(names, take, help));
}

Option Command::addFlag(const std::string& names, const std::function<void()>& set,
                        const std::string& help) {
  return Option(app_->add_flag_callback(names, set, help));
}

Option Command::addFlagWithValue(const std::string& names,
                                 const std::function<void(const std::string&)>& set,
                                 const std::string& help) {
  return Option(app_->add_flag(names)->description(help)->each(set));
}

Command Command::callback(const std::function<void()>& run) {
  return Command(*app_->callback(run));
}
Command Command::requiresCommand() { return Command(*app_->require_subcommand(1)); }
Command Command::footer(const std::string& text) { return Command(*app_->footer(text)); }
Command Command::hidden() { return Command(*app_->group("")); }
Command Command::widerNames() {
  app_->get_formatter()->column_width(32);
  return *this;
}
bool Command::has(const std::string& option) const { return app_->count(option) > 0; }

}  // namespace chromeball
