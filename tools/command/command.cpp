// SPDX-License-Identifier: Apache-2.0
#include "command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "base/error.h"
#include "base/text.h"
#include "help.h"

namespace chromeball {
namespace {

// Numbers as settings read them (base/text.h). CLI11's conversion also takes other bases, white
// space and `true`.
template <class Number>
bool takeWord(const std::string& word, Number& number) {
  return toNumber(word, number);
}
bool takeWord(const std::string& word, float& number) {
  double precise = 0;  // below the smallest float it is 0
  if (!toNumber(word, precise)) return false;
  number = float(precise);
  return true;
}

template <class Number>
bool takeWords(const CLI::results_t& words, Number& number) {
  return takeWord(words.back(), number);
}
template <class Number>
bool takeWords(const CLI::results_t& words, std::optional<Number>& number) {
  return takeWord(words.back(), number.emplace());
}
template <class Number>
bool takeWords(const CLI::results_t& words, std::vector<Number>& numbers) {
  numbers.clear();
  return std::ranges::all_of(
      words, [&](const std::string& word) { return takeWord(word, numbers.emplace_back()); });
}

// Names by which all commands take an option too that has one name in the help.
struct Synonym {
  std::string_view option, other;
};
constexpr Synonym kSynonyms[] = {{"--probe-mapping", "--mapping"},
                                 {"--probe-mapping", "--from"},
                                 {"--probe-rotation", "--rotation"},
                                 {"--probe-scale", "--scale"}};

std::string withSynonyms(const CLI::App& app, const std::string& name) {
  std::string names = name;
  for (const auto& [option, other] : kSynonyms)
    if (name == option && !app.get_option_no_throw(std::string(other)))
      names += fmt::format(",{}", other);
  return names;
}

// Of options that are given again; as the options of settings and flags do, lists take all.
CLI::Option* lastWins(CLI::Option* option) {
  return option->get_positional() ? option
                                  : option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

template <class T>
constexpr bool kIsOfNumbers = std::is_arithmetic_v<T>;
template <class T>
constexpr bool kIsOfNumbers<std::optional<T>> = std::is_arithmetic_v<T>;
template <class T>
constexpr bool kIsOfNumbers<std::vector<T>> = std::is_arithmetic_v<T>;

// As CLI::App::add_option(), but for the conversion.
template <class T>
CLI::Option* addNumberOption(CLI::App& app, const std::string& names, T& value,
                             const std::string& help) {
  CLI::Option* option = app.add_option(
      names, [&value](const CLI::results_t& words) { return takeWords(words, value); }, help, false,
      [&value] { return CLI::detail::checked_to_string<T, T>(value); });
  option->type_name(CLI::detail::type_name<T>());
  option->type_size(CLI::detail::type_count_min<T>::value, CLI::detail::type_count<T>::value);
  return option->expected(CLI::detail::expected_count<T>::value);
}

}  // namespace

Option Option::required() { return Option(option_->required()); }
Option Option::excludes(const Option& other) { return Option(option_->excludes(other.option_)); }
Option Option::excludes(const std::string& name) { return Option(option_->excludes(name)); }
Option Option::inRange(int least, int most) {
  const auto check = [=](const std::string& word) {
    int number = 0;
    const bool isInside = toNumber(word, number) && number >= least && number <= most;
    return isInside ? ""
                    : fmt::format("`{}` is not a whole number from {} to {}", word, least, most);
  };
  return Option(option_->check(check, fmt::format("INT in [{} - {}]", least, most)));
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
  if constexpr (kIsOfNumbers<T>)
    return Option(lastWins(addNumberOption(*app_, names, value, help)));
  else
    return Option(lastWins(app_->add_option(withSynonyms(*app_, names), value, help)));
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
  return Option(lastWins(app_->add_option(withSynonyms(*app_, names), take, help)));
}

Option Command::addJoinedOption(const std::string& names, std::string& value,
                                const std::string& help) {
  const auto join = [&value](const Words& words) {
    value = fmt::format("{}", fmt::join(words, ","));
  };
  return addParsedOption(names, join, help).typeName("TEXT").takesAll();
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
Command Command::briefHelp(const std::vector<std::string>& options, const std::string& examples) {
  helpOf(*app_).shorten(*app_, {options, examples});
  return *this;
}
Command Command::widerNames() {
  app_->get_formatter()->column_width(32);
  return *this;
}
bool Command::has(const std::string& option) const { return app_->count(option) > 0; }
void Command::refuse(std::initializer_list<const char*> options, const std::string& why) const {
  for (const char* option : options)
    if (has(option)) throwInput("{}: {}", option, why);
}

}  // namespace chromeball
